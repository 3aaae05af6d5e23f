"""Free play: home, mission, result, replay, and a simulated rescuer to watch."""
