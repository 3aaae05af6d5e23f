"""What participants are asked: forms and their items as data, read from a study's folder."""
