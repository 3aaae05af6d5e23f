"""What an experimenter watches while a study runs."""
