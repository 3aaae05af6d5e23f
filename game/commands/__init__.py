"""The `ana` subcommands: one module each, imported only when it runs."""
