"""From what a journal tells to tidy rows, and what each of their columns means."""
