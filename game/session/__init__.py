"""Playing a mission with a coach, replaying it and verifying it."""
