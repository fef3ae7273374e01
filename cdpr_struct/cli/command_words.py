"""The command that repeats a run, as reports print it."""


def command_words(name: str, robot: str, payload: float, mass: float | None, **options: object) -> list[str]:
    """Words of the command; options that are None, and a payload of zero, are left out."""
    given = {"--payload": payload or None, "--mass": mass, **options}
    words = (f"{key}={value}" for key, value in given.items() if value is not None)
    return ["cdpr-struct", name, robot, *words, "--out=DIR"]
