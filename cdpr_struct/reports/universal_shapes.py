"""Mode shapes as a universal file: nodes (dataset 15), cables as trace lines (82), a shape a mode (55)."""

from typing import Any

import numpy as np
import pyuff

from cdpr_struct.dynamics.certified_modes import CertifiedModes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.universal_file import PLATFORM_NODE, cable_node, written_sets
from cdpr_struct.reports.figures.robot_geometry import robot_geometry

_STATIONS = 11  # nodes a cable, from the frame to the platform
_NORMAL_MODE, _SIX_FREEDOMS, _DISPLACEMENT, _REAL = 2, 3, 8, 2  # codes of dataset 55
_COLOR = 8


def shapes_file(point: OperatingPoint, found: CertifiedModes) -> bytes:
    """Modes as a universal file, world axes [m, rad at unit modal mass]; its format has six digits.

    The platform's origin is node 1, cable i at the fraction s of its length node 1000 i + 1000 s (999 at the platform).
    """
    count = len(point.entered.cables)
    numbers = [PLATFORM_NODE, *_cable_nodes(count)]
    sets = [_nodes(point, numbers), *(_line(number, i) for number, i in enumerate(range(count), start=1))]
    stations = np.linspace(0.0, 1.0, _STATIONS)
    moved = found.shapes.cable_motion(stations)
    for k, hertz in enumerate(found.frequencies.hertz):
        motion = np.zeros((len(numbers), 6))
        motion[0] = found.shapes.platform[k]
        motion[1:, :3] = moved[k].reshape(-1, 3)
        sets.append(_shape(point.entered.name, k + 1, float(hertz), motion, numbers))
    return written_sets(sets)


def _cable_nodes(count: int) -> list[int]:
    return [cable_node(i, station) for i in range(count) for station in np.linspace(0.0, 1.0, _STATIONS)]


def _nodes(point: OperatingPoint, numbers: list[int]) -> dict[str, Any]:
    curves = robot_geometry(point).curves
    places = curves[:, np.linspace(0, curves.shape[1] - 1, _STATIONS).astype(int)].reshape(-1, 3)
    x, y, z = np.vstack([point.position, places]).T
    zeros = [0] * len(numbers)
    return dict(
        pyuff.prepare_15(node_nums=numbers, def_cs=zeros, disp_cs=zeros, color=[_COLOR] * len(numbers), x=x, y=y, z=z)
    )


def _line(number: int, cable: int) -> dict[str, Any]:
    """A cable as lines between its nodes, the last one to the platform's origin."""
    nodes = [*_cable_nodes(cable + 1)[-_STATIONS:], PLATFORM_NODE]
    return dict(
        pyuff.prepare_82(
            trace_num=number, n_nodes=len(nodes), color=_COLOR, id=f"cable {cable + 1}", nodes=np.array(nodes)
        )
    )


def _shape(robot: str, number: int, hertz: float, motion: np.ndarray, nodes: list[int]) -> dict[str, Any]:
    parts = {f"r{axis + 1}": motion[:, axis] for axis in range(6)}
    return dict(
        pyuff.prepare_55(
            id1=f"{robot}: mode {number}", id2="predicted by cdpr-struct", id3="NONE", id4="NONE", id5="NONE",
            model_type=1, analysis_type=_NORMAL_MODE, data_ch=_SIX_FREEDOMS, spec_data_type=_DISPLACEMENT,
            data_type=_REAL, n_data_per_node=6, load_case=1, mode_n=number, freq=hertz, modal_m=1.0,
            modal_damp_vis=0.0, modal_damp_his=0.0, node_nums=nodes, **parts,
        )
    )  # fmt: skip
