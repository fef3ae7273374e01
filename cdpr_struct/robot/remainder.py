"""What no cause explains of a robot, as a random law: at every rest another error, independent of all others."""

from dataclasses import astuple, dataclass, fields, replace

import numpy as np
from scipy.linalg import block_diag

from cdpr_struct.robot.tolerances import VARIED, Spread, Varied, change_count, places

Three = tuple[float, float, float]
_NONE: Three = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Remainder:
    """Rms of normal errors that a robot has anew at every rest.

    force_N, moment_Nm : of the parts along x, y, z of a force and moment on the platform origin, world axes
    length_m           : of the length of each cable by itself
    common_length_m    : of an error of all lengths alike
    frequency          : relative, of each natural frequency

    Raises
    ------
    ValueError : a size that is negative or no number, or a force that has not three parts.
    """

    force_N: Three = _NONE
    moment_Nm: Three = _NONE
    length_m: float = 0.0
    common_length_m: float = 0.0
    frequency: float = 0.0

    def __post_init__(self) -> None:
        for one, value in zip(fields(self), astuple(self), strict=True):
            sizes, parts = np.asarray(value, dtype=float), one.name in ("force_N", "moment_Nm")
            if sizes.shape != ((3,) if parts else ()) or not ((sizes >= 0.0) & (sizes < np.inf)).all():
                wanted = "three numbers, each zero or more" if parts else "zero or more"
                raise ValueError(f"Remainder.{one.name} must be {wanted}, got {value!r}")

    def beside(self, spread: Spread, cables: int) -> Spread:
        """Robots that are probable at a rest: those of a spread, each with errors of its own."""
        known = {one.field for one in spread.found}
        varied = (*spread.varied, *(Varied.found(name) for name in ("force", "moment") if name not in known))
        own = dict(zip((one.field for one in varied), places(cables, varied), strict=True))
        lengths = np.hstack([self.length_m * np.eye(cables), np.full((cables, 1), self.common_length_m)])
        count = change_count(cables, varied)
        errors = np.zeros((count, 6 + lengths.shape[1]))
        rows = np.concatenate([np.arange(count)[own[field]] for field in ("force", "moment", "length_offset")])
        errors[rows] = block_diag(np.diag(self.force_N), np.diag(self.moment_Nm), lengths)
        more = count - len(spread.mean)
        root = np.hstack([np.pad(spread.root, [(0, more), (0, 0)]), errors[:, errors.any(axis=0)]])
        mean, scatter = np.pad(spread.mean, (0, more)), float(np.hypot(spread.scatter, self.frequency))
        return replace(spread, root=root, mean=mean, found=varied[len(VARIED) :], scatter=scatter)
