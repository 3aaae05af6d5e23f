"""The design cells, allocation, protocol phases, instruments and the ledger of participants."""
