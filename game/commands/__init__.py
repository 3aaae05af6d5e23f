"""The bodies of the `ana` subcommands: one module each, imported when it is run."""
