"""Simulated people, who see the same Observation as the screen and nothing more."""
