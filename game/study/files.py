"""The files that make a folder a study, and what is said of one that has neither."""

SETTINGS, LEDGER = "study.toml", "ledger.jsonl"
NO_STUDY, NEW_STUDY = "there is no study here", "`ana study new` makes a study folder"
