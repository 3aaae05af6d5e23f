"""Offices made from a seed."""
