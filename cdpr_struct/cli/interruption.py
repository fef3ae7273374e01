"""How a command that the user interrupted says what is left of its work."""

CODE = 130  # of a program ended by an interrupt


class Interrupted(Exception):
    """The user stopped the command; the message says what was kept."""
