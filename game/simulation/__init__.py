"""Whole studies with simulated people, in journals of the same form as real ones."""
