"""What should be measured next? See README.md for the files of this room."""
