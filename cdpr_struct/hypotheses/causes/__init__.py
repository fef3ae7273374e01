"""Everything that may be wrong, one family of hypotheses a file."""
