"""Arrays of MATLAB files as channels: a vector is one, a matrix one for each of its columns or rows."""

from collections.abc import Iterator

import numpy as np

_MOST = 64  # columns of a matrix that are channels each; more are images or results
_FEWEST = 2  # samples


def columns(name: str, shape: tuple[int, ...]) -> Iterator[tuple[str, int]]:
    """Names of the channels of an array as MATLAB writes them, and which column or row (from 0) each is.

    Samples run along the longer side: (600, 3) holds q(:,1), q(:,2), q(:,3), and (3, 600) q(1,:), q(2,:), q(3,:).
    """
    long = [n for n in shape if n > 1]
    if len(long) == 1 and long[0] >= _FEWEST:
        yield name, 0
    elif len(shape) == 2 and min(shape) <= _MOST:
        for i in range(min(shape)):
            yield (f"{name}(:,{i + 1})" if shape[0] >= shape[1] else f"{name}({i + 1},:)"), i


def column(values: np.ndarray, place: int) -> np.ndarray:
    """(n,) the samples of a channel of an array as `columns` counts them."""
    whole = np.asarray(values)
    if whole.size == max(whole.shape):
        return whole.ravel()
    return whole[:, place] if whole.shape[0] >= whole.shape[1] else whole[place]
