"""From journals or one long CSV to tidy tables, models, numbers and figures."""
