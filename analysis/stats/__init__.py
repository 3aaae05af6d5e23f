"""The statistics, one module a method."""
