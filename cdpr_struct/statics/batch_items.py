"""Values whose fields all have one axis of items in front, of which a search goes on with some."""

from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class BatchItems:
    """Arrays (k, ...) of k items; a search adds the fields."""

    def take(self, index: np.ndarray) -> Self:
        """Some items."""
        return replace(self, **{own.name: getattr(self, own.name)[index] for own in fields(self)})

    def replaced(self, index: np.ndarray, other: Self) -> Self:
        """This with the items `index` taken from another; works in place."""
        for own in fields(self):
            getattr(self, own.name)[index] = getattr(other, own.name)
        return self
