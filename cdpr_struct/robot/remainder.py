"""What no cause explains of a robot, as a random law: at every rest another error, independent of all others."""

from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.robot.tolerances import VARIED, Spread, Varied, change_count, places


@dataclass(frozen=True, slots=True)
class Remainder:
    """Rms of normal errors that a robot has anew at every rest.

    force_N, moment_Nm : each component of a force and moment on the platform origin, world axes
    length_m           : the length of each cable
    frequency          : relative, each natural frequency

    Raises
    ------
    ValueError : a size that is negative or no number.
    """

    force_N: float = 0.0
    moment_Nm: float = 0.0
    length_m: float = 0.0
    frequency: float = 0.0

    def __post_init__(self) -> None:
        for one in fields(self):
            if not 0.0 <= getattr(self, one.name) < np.inf:
                raise ValueError(f"Remainder.{one.name} must be zero or more, got {getattr(self, one.name)!r}")

    def beside(self, spread: Spread, cables: int) -> Spread:
        """Robots that are probable at a rest: those of a spread, each with errors of its own."""
        known = {one.field for one in spread.found}
        new = tuple(Varied.found(name) for name in ("force", "moment") if name not in known)
        varied = (*spread.varied, *new)
        own = dict(zip((one.field for one in varied), places(cables, varied), strict=True))
        count = change_count(cables, varied)
        sizes = np.zeros(count)
        for field, size in (("force", self.force_N), ("moment", self.moment_Nm), ("length_offset", self.length_m)):
            sizes[own[field]] = size
        more = count - len(spread.mean)
        root = np.hstack([np.pad(spread.root, [(0, more), (0, 0)]), np.diag(sizes)[:, sizes > 0.0]])
        scatter = float(np.hypot(spread.scatter, self.frequency))
        return replace(
            spread, root=root, mean=np.pad(spread.mean, (0, more)), found=varied[len(VARIED) :], scatter=scatter
        )
