"""A mission and a coach played together, the journal, replay and verification."""
