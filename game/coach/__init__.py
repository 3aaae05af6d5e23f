"""The coach: the human model, the adaptive cycle, the route and the instructions."""
