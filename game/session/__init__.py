"""A mission and a coach played together, replayed, and verified."""
