"""The journal: its records, how they are written and read, and the history they add up to."""
