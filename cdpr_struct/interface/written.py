"""Text files that a caller names, never over another one unasked."""

from pathlib import Path

from cdpr_struct.errors import InputError


def write_text(path: Path, text: str, overwrite: bool) -> Path:
    """Write a text file and return its path.

    Raises
    ------
    InputError : there is a file already, or it cannot be written.
    """
    try:
        with path.open("w" if overwrite else "x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError as error:
        raise InputError("path", "", str(path), "a name that no file has yet, or overwrite=True") from error
    except OSError as error:
        raise InputError("path", "", str(path), f"a file that can be written ({error.strerror})") from error
    return path
