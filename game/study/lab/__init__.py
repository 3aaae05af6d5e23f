"""What a lab does with a study: watch it, let participants in and out, export its data."""
