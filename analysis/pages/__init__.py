"""The tables and figures of the notebooks, one module a question."""
