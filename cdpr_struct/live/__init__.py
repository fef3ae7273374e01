"""A live view of a robot: sliders in, lines, tensions and modes out; one file that knows the browser window."""
