"""What one rescuer knows, room by room, and how long a leg will take them at each level."""
