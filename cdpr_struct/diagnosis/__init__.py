"""What does the simulation get wrong, why, and how much does a better model gain? See README.md."""
