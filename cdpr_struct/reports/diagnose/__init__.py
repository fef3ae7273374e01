"""The results of `diagnose`: rendered, nothing is computed here."""
