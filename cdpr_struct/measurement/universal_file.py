"""Frequency responses and motions in time as universal files (dataset 58), the exchange format of modal tests."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyuff

from cdpr_struct.dynamics.frequency_response import FrequencyResponse, Quantity
from cdpr_struct.dynamics.ports import CablePort, Port

TIME_RESPONSE, FREQUENCY_RESPONSE = 1, 4  # function types of dataset 58
_TIME, _FREQUENCY, _FORCE = 17, 18, 13  # specific data types
_ORDINATE: Mapping[Quantity, int] = {"displacement": 8, "velocity": 11, "acceleration": 12}
_TIME_UNIT: Mapping[Quantity, str] = {"displacement": "", "velocity": "/s", "acceleration": "/s^2"}
PLATFORM_NODE = 1


def response_sets(response: FrequencyResponse, robot: str, axes: np.ndarray) -> list[dict[str, Any]]:
    """One dataset 58 per responding port, in pyuff's form.

    axes : (3, 3) columns are the axes of the ports' degrees of freedom in the world

    The platform point is node 1, cable i at station s node 1000 i + 1000 s (rounded); directions 1 2 3 are x y z,
    4 5 6 rotations about them.
    """
    sets = []
    for column, port in enumerate(response.respond):
        unit = response_unit(port, response.excite, response.quantity)
        sets.append(
            pyuff.prepare_58(
                binary=0, func_type=FREQUENCY_RESPONSE,
                id1=f"{robot}: {port.name} over {response.excite.name}", id2=f"{response.quantity} in {unit}",
                id3="predicted by cdpr-struct", id4="NONE", id5="NONE",
                rsp_ent_name="ROBOT", rsp_node=node(port), rsp_dir=direction(port, axes),
                ref_ent_name="ROBOT", ref_node=node(response.excite), ref_dir=direction(response.excite, axes),
                abscissa_spacing=1, abscissa_spec_data_type=_FREQUENCY, abscissa_axis_units_lab="Hz",
                ordinate_spec_data_type=_ORDINATE[response.quantity], ordinate_axis_units_lab=unit.partition("/(")[0],
                orddenom_spec_data_type=_FORCE, orddenom_axis_units_lab="N m" if response.excite.turns else "N",
                data=response.response[:, column], x=response.hertz,
            )
        )  # fmt: skip
    return sets


def universal_file(response: FrequencyResponse, robot: str, axes: np.ndarray) -> bytes:
    """The responses as a universal file: text with 12 digits, which every reader takes."""
    return written_sets(response_sets(response, robot, axes))


def motion_file(
    time: np.ndarray, acceleration: np.ndarray, ports: Sequence[Port], robot: str, axes: np.ndarray
) -> bytes:
    """Accelerations (n, ports) at evenly spaced instants (n,) [s] as a universal file, a dataset 58 per port.

    Nodes, directions and `axes` as in `response_sets`; the format gives the time step six digits.
    """
    return written_sets([_motion_set(time, acceleration[:, k], port, robot, axes) for k, port in enumerate(ports)])


def _motion_set(time: np.ndarray, signal: np.ndarray, port: Port, robot: str, axes: np.ndarray) -> dict[str, Any]:
    unit = "rad/s^2" if port.turns else "m/s^2"
    return dict(
        pyuff.prepare_58(
            binary=0, func_type=TIME_RESPONSE, id1=f"{robot}: {port.name}", id2=f"acceleration in {unit}",
            id3="predicted by cdpr-struct", id4="NONE", id5="NONE", rsp_ent_name="ROBOT", rsp_node=node(port),
            rsp_dir=direction(port, axes), ref_ent_name="NONE", ref_node=0, ref_dir=0, abscissa_spacing=1,
            abscissa_spec_data_type=_TIME, abscissa_axis_units_lab="s",
            ordinate_spec_data_type=_ORDINATE["acceleration"], ordinate_axis_units_lab=unit,
            orddenom_spec_data_type=0, orddenom_axis_units_lab="NONE", data=signal, x=time,
        )
    )  # fmt: skip


def written_sets(sets: list[dict[str, Any]]) -> bytes:
    """Bytes of a universal file; pyuff writes to a path only."""
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "sets.uff"
        pyuff.UFF(str(path)).write_sets(sets, mode="add")
        return path.read_bytes()


def node(port: Port) -> int:
    """Node number of the port's point."""
    return cable_node(port.cable, port.station) if isinstance(port, CablePort) else PLATFORM_NODE


def cable_node(cable: int, station: float) -> int:
    """Node number of a point of a cable, counted from 0, at a fraction of its length from the frame."""
    return 1000 * (cable + 1) + min(round(1000.0 * station), 999)


def direction(port: Port, axes: np.ndarray) -> int:
    """Direction code of the port: 1, 2, 3 along and 4, 5, 6 about the axes that it was named after."""
    if isinstance(port, CablePort):
        return int(np.abs(axes.T @ port.direction).argmax()) + 1
    along = port.twist[3:] if port.turns else port.twist[:3]
    return int(np.abs(axes.T @ along).argmax()) + (4 if port.turns else 1)


def response_unit(respond: Port, excite: Port, quantity: Quantity) -> str:
    """Unit of a response, like (m/s^2)/N."""
    over = "(N m)" if excite.turns else "N"
    above = ("rad" if respond.turns else "m") + _TIME_UNIT[quantity]
    return f"({above})/{over}" if "/" in above else f"{above}/{over}"
