"""What helps if the cables do not hold the orientation of a grid at every pose?"""

from collections.abc import Mapping, Sequence
from typing import Any

_ENOUGH = 8  # so many cables or more hold a given orientation over most of their workspace
_PLACED = 3  # fewer cannot place a platform


def what_helps(result: Mapping[str, Any], quantities: Sequence[str]) -> str:
    """A sentence on `--free` or `--lengths`, with a space before it; none where neither would help.

    Parameters
    ----------
    result : of a map, with `cables`, `poses`, `held`, and `guided` or `free` if there are any
    quantities : that were asked for
    """
    cables, guided = result["cables"], result.get("guided", [])
    if result["held"] == result["poses"] or "free" in result:
        return ""
    lock = "lock --lengths instead (forward, modes)." if cables + len(guided) < 6 and not result["held"] else ""
    oriented = any(name.startswith("mode-") for name in quantities)
    if guided or oriented or not _PLACED <= cables < _ENOUGH:
        many = f"{cables} cable" + ("s" if cables > 1 else "")
        return f" With {many} hardly any given pose is in balance; {lock}" if lock else ""
    free = f" {cables} cables hold a given orientation at few poses: --free rx,ry,rz lets the platform hang."
    return free + (f" Or {lock}" if lock else "")
