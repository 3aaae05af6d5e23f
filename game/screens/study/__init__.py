"""The screens of a study session: what a participant sees, one file a screen."""
