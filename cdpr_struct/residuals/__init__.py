"""What do readings leave of the model, linear about a point? See README.md."""
