"""How probable is everything that may be wrong with a campaign? See README.md."""
