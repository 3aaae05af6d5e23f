"""What a participant goes through: the timeline, the tasks, and the session that records them."""
