"""Tidy rows made from journals, and what each of their columns means."""
