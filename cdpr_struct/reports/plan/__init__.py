"""The report of a test plan, and the words for further measurements."""
