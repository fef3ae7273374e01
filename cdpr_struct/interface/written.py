"""Text files that a caller names, never over another one unasked."""

import os
import tempfile
from pathlib import Path

from cdpr_struct.errors import InputError


def write_text(path: Path, text: str, overwrite: bool) -> Path:
    """Write a text file, whole or not at all, and return its path.

    Raises
    ------
    InputError : there is a file already, or it cannot be written.
    """
    if not overwrite and path.exists():
        raise InputError("path", "", str(path), "a name that no file has yet, or overwrite=True")
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:100]}.")
        try:
            with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
            Path(temporary).chmod(0o644)
            Path(temporary).replace(path)
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise InputError("path", "", str(path), f"a file that can be written ({error.strerror})") from error
    return path
