"""The mission as lines of text, for a screen reader or a script."""
