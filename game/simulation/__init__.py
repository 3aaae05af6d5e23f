"""Whole studies with simulated people, as journals of the very same form (design 10)."""
