"""`ana`: a guided rescue mission with an adaptive coach, and the study around it."""

__version__ = "0.1.0"
