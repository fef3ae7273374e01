"""Names of degrees of freedom: fz, my, x, rz, cable5@0.3:z."""

import re
from collections.abc import Iterable

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import CablePort, Port, platform_port
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import read_numbers
from cdpr_struct.interface.given import Numbers

_PLATFORM = re.compile(r"(?P<turn>m|r)?(?P<force>f)?(?P<axis>[xyz])")
_CABLE = re.compile(r"cable(?P<number>\d+)@(?P<station>[0-9.eE+-]+):f?(?P<axis>[xyz])")
_FORM = "fx fy fz mx my mz, x y z rx ry rz, or a point of a cable like cable5@0.3:z (0 at the frame, 1 at the platform)"


def read_ports(
    given: str | Iterable[str], option: str, point: OperatingPoint, frame: str = "world", at: Numbers | None = None
) -> tuple[Port, ...]:
    """The degrees of freedom that are named, in a row or in one text with commas between them.

    Raises
    ------
    InputError : an unknown name, a cable that the robot does not have, or a station outside 0..1.
    """
    if frame not in ("world", "platform"):
        raise InputError("frame", "", frame, "world or platform")
    axes = point.rotation if frame == "platform" else np.eye(3)
    arm = np.zeros(3) if at is None else point.rotation @ read_numbers(at, "at", (3,), "coordinates in m")
    names = given.split(",") if isinstance(given, str) else list(given) if isinstance(given, Iterable) else [given]
    if not all(isinstance(name, str) for name in names):
        raise InputError(option, "", given, f"one of: {_FORM}")
    return tuple(_port(name.strip(), option, point, axes, arm) for name in names)


def _port(name: str, option: str, point: OperatingPoint, axes: np.ndarray, arm: np.ndarray) -> Port:
    if name.startswith("cable"):
        return _cable_port(name, option, point, axes)
    found = _PLATFORM.fullmatch(name)
    if found is None or (found["turn"] and found["force"]):
        raise InputError(option, "", name, f"one of: {_FORM}")
    return platform_port(name, axes[:, "xyz".index(found["axis"])], found["turn"] is not None, arm)


def _cable_port(name: str, option: str, point: OperatingPoint, axes: np.ndarray) -> CablePort:
    found = _CABLE.fullmatch(name)
    try:
        station = float(found["station"]) if found else float("nan")
    except ValueError:
        station = float("nan")
    if found is None or not 0.0 < station < 1.0:
        raise InputError(option, "", name, f"one of: {_FORM}")
    cables = len(point.entered.cables)
    if not 1 <= int(found["number"]) <= cables:
        raise InputError(option, "", name, f"a cable from 1 to {cables}")
    return CablePort(name, int(found["number"]) - 1, station, axes[:, "xyz".index(found["axis"])])
