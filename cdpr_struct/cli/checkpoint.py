"""Finished parts of long work on disk, so that an interrupted run continues where it stopped."""

import io
import shutil
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cdpr_struct.cli.written_files import write_whole
from cdpr_struct.errors import InputError

Columns = dict[str, np.ndarray]


class Checkpoint:
    """Parts under DIR/.checkpoint-FINGERPRINT, one file each, whole or absent.

    The fingerprint names everything that the result depends on, so parts of another robot, load or grid are never
    mixed in.
    """

    def __init__(self, directory: Path, fingerprint: str) -> None:
        self.folder = directory / f".checkpoint-{fingerprint}"

    def parts(self, names: Sequence[str]) -> dict[int, Columns]:
        """Parts that are there and can be read, by their number among `names`."""
        found = {i: _read(self._path(name)) for i, name in enumerate(names) if self._path(name).exists()}
        return {i: columns for i, columns in found.items() if columns is not None}

    def keep(self, name: str, columns: Columns) -> None:
        """Write a finished part.

        Raises
        ------
        InputError : the directory cannot be written.
        """
        buffer = io.BytesIO()
        np.savez(buffer, **columns)  # type: ignore[arg-type]
        try:
            self._write(name, buffer.getvalue())
        except OSError as error:
            raise InputError(
                "--out", "", str(self.folder.parent), f"a directory that can be written ({error.strerror})"
            ) from error

    def clear(self) -> None:
        """Remove the parts; the finished result stands for them. What another run removed already is no matter."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _write(self, name: str, content: bytes) -> None:
        """Write a part; once more where the same command, run beside this one, ended and removed the folder."""
        for last in (False, True):
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                return write_whole(self._path(name), content)
            except FileNotFoundError:
                if last:
                    raise
        return None

    def _path(self, name: str) -> Path:
        return self.folder / f"chunk-{name}.npz"


def _read(path: Path) -> Columns | None:
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
