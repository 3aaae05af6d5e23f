"""Reads journals, tables and long CSV files, and checks what it reads."""
