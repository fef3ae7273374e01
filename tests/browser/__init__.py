"""Report pages in a browser."""
