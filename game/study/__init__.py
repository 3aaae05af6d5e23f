"""A study: its design, settings, texts and ledger; the rooms are `protocol` and `lab`."""
