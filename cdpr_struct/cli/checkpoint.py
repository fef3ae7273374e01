"""Finished chunks of a sweep on disk, so that an interrupted run continues where it stopped."""

import io
import zipfile
from pathlib import Path

import numpy as np

from cdpr_struct.cli.written_files import write_whole
from cdpr_struct.errors import InputError

Columns = dict[str, np.ndarray]


class Checkpoint:
    """Chunks under DIR/.checkpoint-FINGERPRINT, one file each, whole or absent.

    The fingerprint names everything that the result depends on, so chunks of another robot, load or grid are never
    mixed in.
    """

    def __init__(self, directory: Path, fingerprint: str) -> None:
        self.folder = directory / f".checkpoint-{fingerprint}"

    def chunks(self, count: int) -> dict[int, Columns]:
        """Chunks by number that are there and can be read, of `count`."""
        found = {number: _read(self._path(number)) for number in range(count) if self._path(number).exists()}
        return {number: columns for number, columns in found.items() if columns is not None}

    def keep(self, number: int, columns: Columns) -> None:
        """Write a finished chunk.

        Raises
        ------
        InputError : the directory cannot be written.
        """
        buffer = io.BytesIO()
        np.savez(buffer, **columns)  # type: ignore[arg-type]
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self._path(number), buffer.getvalue())
        except OSError as error:
            raise InputError(
                "--out", "", str(self.folder.parent), f"a directory that can be written ({error.strerror})"
            ) from error

    def clear(self) -> None:
        """Remove the chunks; the finished result stands for them."""
        if self.folder.is_dir():
            for path in self.folder.iterdir():
                path.unlink()
            self.folder.rmdir()

    def _path(self, number: int) -> Path:
        return self.folder / f"chunk-{number:06d}.npz"


def _read(path: Path) -> Columns | None:
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
