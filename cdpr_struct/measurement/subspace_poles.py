"""Poles of a signal's covariance Hankel matrix at all model orders, by the stochastic subspace method of pyOMA-2.

The one file that knows pyOMA-2. Of its package only the computing functions are imported; what it prints is caught.
"""

import contextlib
import importlib
import io
import logging
from collections.abc import Iterator
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from cdpr_struct.errors import InputError

INSTALL = "install the extra for ambient records: pip install 'cdpr-struct[ambient]'"
MOST_DAMPED = 0.1  # ratio: poles of more are noise
STEP = 2  # states between two model orders: a mode has two


@dataclass(frozen=True, slots=True, eq=False)
class Poles:
    """Poles at o model orders, p at most at each, of each conjugate pair one; nan where there are fewer.

    order : (o,) number of states
    pole  : (o, p) complex [rad/s], imaginary part above zero
    shape : (o, p, c) complex, each of unit length
    """

    order: np.ndarray
    pole: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Hankel:
    """Block Hankel matrix of the covariances of c channels, and those of contiguous blocks of the record.

    matrix : (rows c, rows c);  blocks : (b, rows c, rows c), their mean is nearly the matrix
    """

    matrix: np.ndarray
    blocks: np.ndarray
    rows: int

    def without(self, block: int) -> np.ndarray:
        """The matrix of the record without one of its blocks."""
        others = np.arange(len(self.blocks)) != block
        mean: np.ndarray = self.blocks[others].mean(axis=0)
        return mean

    def halves(self) -> tuple[np.ndarray, np.ndarray]:
        """The matrices of the first and the second half of the blocks."""
        half = len(self.blocks) // 2
        return self.blocks[:half].mean(axis=0), self.blocks[half:].mean(axis=0)


def require_pyoma() -> None:
    """Refuse to begin without pyOMA-2.

    Raises
    ------
    InputError : it is not installed.
    """
    _functions("ssi")


def hankel(signal: np.ndarray, rows: int, blocks: int) -> Hankel:
    """Hankel matrix of a signal (n, c), with `rows` block rows, whole and of each of `blocks` blocks."""
    ssi, data = _functions("ssi"), np.ascontiguousarray(signal.T)
    with _quiet():
        matrix, spread = ssi.build_hank(data, data, rows, "cov", calc_unc=True, nb=blocks)
    away = spread.T.reshape((blocks, *matrix.shape), order="C").transpose(0, 2, 1)  # each was stacked column by column
    return Hankel(matrix, matrix + away * np.sqrt(blocks * (blocks - 1.0)), rows)


def poles(matrix: np.ndarray, rows: int, most: int, step: float, every: int = STEP) -> Poles:
    """Poles of a Hankel matrix at the orders `every`, 2 `every`, ... up to `most`.

    step : between samples [s]
    """
    ssi = _functions("ssi")
    with _quiet():
        observability, transition, output, _ = ssi.SSI_fast(matrix, rows, most, every)
        found = ssi.SSI_poles(observability, transition, output, most, step, every, True, MOST_DAMPED)
    pole, shape = found[3].T[1:], found[2].transpose(1, 0, 2)[1:]
    swings = np.isfinite(pole) & (np.abs(pole.imag) > 0.0)
    upper = np.where(pole.imag < 0.0, pole.conj(), pole)
    shape = np.where((pole.imag < 0.0)[..., None], shape.conj(), shape)
    size = np.linalg.norm(np.where(swings[..., None], shape, 0.0), axis=-1, keepdims=True)
    return Poles(
        np.arange(every, most + 1, every),
        np.where(swings, upper, complex(np.nan, np.nan)),
        np.where(swings[..., None], shape / np.where(size > 0.0, size, 1.0), complex(np.nan, np.nan)),
    )


def spectral_density(signal: np.ndarray, step: float, segment: int) -> tuple[np.ndarray, np.ndarray]:
    """Lines (f,) [Hz] and singular values (f, c), descending, of the spectral density of a signal (n, c).

    segment : samples of each windowed part (Hann, half overlapping)
    """
    fdd, data = _functions("fdd"), np.ascontiguousarray(signal.T)
    with _quiet():
        hertz, density = fdd.SD_est(data, data, step, segment, "per")
    return hertz, np.linalg.svd(np.moveaxis(density, 2, 0), compute_uv=False)


def _functions(name: str) -> ModuleType:
    """A module of pyOMA-2's computing functions; its import changes NumPy's error state, which is put back."""
    with np.errstate():
        try:
            found = importlib.import_module(f"pyoma2.functions.{name}")
        except ImportError as error:
            raise InputError("ambient record", "", "no package `pyOMA-2`", INSTALL) from error
    logging.getLogger("pyoma2").setLevel(logging.ERROR)
    return found


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Without the progress bars of pyOMA-2, and without warnings of its numbers that are none."""
    with contextlib.redirect_stderr(io.StringIO()), np.errstate(all="ignore"):
        yield
