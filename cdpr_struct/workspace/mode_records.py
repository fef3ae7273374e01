"""Arrays as columns of a map: one record a pose. Shapes are kept in half precision.

So a map's chunks are handed over, kept on disk and put together like those of any other quantity.
"""

import numpy as np

_SEEN = 0.1  # of a mode's mass: less of it in a shape is no shape to be compared


def unit_shapes(shapes: np.ndarray) -> np.ndarray:
    """Shapes (..., d) of length one in half precision; zero where there is none."""
    size = np.sqrt((np.nan_to_num(shapes) ** 2).sum(axis=-1, keepdims=True))
    seen = size**2 > _SEEN
    return np.where(seen, np.nan_to_num(shapes) / np.where(seen, size, 1.0), 0.0).astype(np.float16)


def as_records(values: np.ndarray) -> np.ndarray:
    """(n,) records of the rows of an array (n, ...)."""
    record = np.empty(len(values), dtype=[("row", values.dtype, values.shape[1:])])
    record["row"] = values
    return record


def of_records(record: np.ndarray) -> np.ndarray:
    """The array (n, ...) of a column of records."""
    return np.asarray(record["row"])
