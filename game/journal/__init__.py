"""The journal: its records, how they are written and read, and what a whole journal tells."""
