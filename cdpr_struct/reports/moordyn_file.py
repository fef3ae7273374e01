"""A robot at rest as an input file of MoorDyn v2, or of MoorPy: a free body on lines, in water without density.

Both codes read one format, but take a body's three angles in different orders. Both know water; the model sits below
its surface, lower by a shift that the head of the file names.
"""

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.dynamics.operating_point import OperatingPoint

Peer = Literal["moorpy", "moordyn"]
_SEGMENTS = 40
_BELOW = 1.0  # m between the highest point and the surface
_STEEL = 7850.0  # kg/m^3: the diameter is that of a steel rod; nothing depends on it without water
_TIME = {"dtM": "1e-4", "TmaxIC": "0", "dtIC": "1.0"}


def water_shift(point: OperatingPoint) -> float:
    """How far the model is lowered [m]."""
    ends = np.concatenate([_frame_ends(point), point.position[None, :] + _arms(point)])
    return float(math.ceil(ends[:, 2].max() + _BELOW))


def moordyn_text(point: OperatingPoint, peer: Peer) -> str:
    """The input file of one of the two codes.

    One line type a cable; fixed points where the free cables begin, points on the body where they end. Products of
    inertia have no place in the format.
    """
    robot, shift = point.entered, water_shift(point)
    return "\n".join(
        [
            "--------------------- MoorDyn v2 Input File ------------------------------------------",
            f"{_plain(robot.name)}, by cdpr-struct; all heights are lower by {shift:g} m than in the robot file",
            *_line_types(point),
            *_body(point, shift, peer),
            *_points(point, shift),
            *_lines(point),
            *_options({**_TIME, "g": repr(float(robot.gravity)), "WtrDpth": f"{shift + 100.0:g}", "rho": "0.0"}),
            "---------------------- OUTPUTS --------------------------------------------------------",
            *(f"FairTen{i}" for i in range(1, len(robot.cables) + 1)),
            "--------------------- need this line --------------------------------------------------",
            "",
        ]
    )


def _frame_ends(point: OperatingPoint) -> np.ndarray:
    """(m, 3) where the free cables begin: the frame anchors, or the exits of pulleys."""
    return np.asarray(point.position + _arms(point) - point.cables.offset)


def _arms(point: OperatingPoint) -> np.ndarray:
    return np.asarray(point.entered.platform_anchors @ point.rotation.T)


def _line_types(point: OperatingPoint) -> list[str]:
    cables, gravity = point.cables, point.entered.gravity
    lines = [
        "---------------------- LINE TYPES -----------------------------------------------------",
        "Name      Diam      MassDen   EA        BA/-zeta  EI        Cd        Ca        CdAx      CaAx",
        "(-)       (m)       (kg/m)    (N)       (N-s/-)   (N-m^2)   (-)       (-)       (-)       (-)",
    ]
    for i, (stiffness, weight) in enumerate(zip(cables.axial_stiffness, cables.weight, strict=True), start=1):
        density = float(weight) / gravity
        diameter = math.sqrt(4.0 * density / (math.pi * _STEEL))
        lines.append(f"cable{i} {diameter:.6g} {density!r} {float(stiffness)!r} -0.8 0.0 0.0 0.0 0.0 0.0")
    return lines


def _body(point: OperatingPoint, shift: float, peer: Peer) -> list[str]:
    body, robot = point.entered.platform, point.entered
    x, y, z = (float(v) for v in point.position - np.array([0.0, 0.0, shift]))
    turned = " ".join(repr(float(v)) for v in _angles(point.rotation, peer))
    center = "|".join(repr(float(v)) for v in body.center_of_mass)
    moments = "|".join(repr(float(v)) for v in np.diag(body.inertia))
    return [
        "---------------------- BODIES ---------------------------------------------------------",
        "ID   Attachment  X0  Y0  Z0  r0  p0  y0  Mass  CG*  I*  Volume  CdA*  Ca*",
        "(#)  (-)  (m)  (m)  (m)  (deg)  (deg)  (deg)  (kg)  (m)  (kg-m^2)  (m^3)  (m^2)  (-)",
        f"1 free {x!r} {y!r} {z!r} {turned} {robot.platform.mass!r} {center} {moments} 0.0 0.0 0.0",
    ]


def _points(point: OperatingPoint, shift: float) -> list[str]:
    lines = [
        "---------------------- POINTS ---------------------------------------------------------",
        "ID   Attachment  X  Y  Z  Mass  Volume  CdA  Ca",
        "(#)  (-)  (m)  (m)  (m)  (kg)  (m^3)  (m^2)  (-)",
    ]
    fixed, moving = _frame_ends(point) - np.array([0.0, 0.0, shift]), point.entered.platform_anchors
    for i, (begin, end) in enumerate(zip(fixed, moving, strict=True)):
        lines.append(f"{2 * i + 1} fixed {_three(begin)} 0 0 0 0")
        lines.append(f"{2 * i + 2} body1 {_three(end)} 0 0 0 0")
    return lines


def _lines(point: OperatingPoint) -> list[str]:
    lines = [
        "---------------------- LINES ----------------------------------------------------------",
        "ID   LineType  AttachA  AttachB  UnstrLen  NumSegs  LineOutputs",
        "(#)  (-)  (#)  (#)  (m)  (-)  (-)",
    ]
    for i, length in enumerate(point.cables.length, start=1):
        lines.append(f"{i} cable{i} {2 * i - 1} {2 * i} {float(length)!r} {_SEGMENTS} -")
    return lines


def _options(values: Mapping[str, str]) -> list[str]:
    head = "---------------------- OPTIONS --------------------------------------------------------"
    return [head, *(f"{value} {name}" for name, value in values.items())]


def _angles(rotation: np.ndarray, peer: Peer) -> np.ndarray:
    """Roll, pitch, yaw [deg]: of R = Rx Ry Rz in MoorDyn, of R = Rz Ry Rx in MoorPy."""
    turned = Rotation.from_matrix(rotation)
    if peer == "moordyn":
        return np.asarray(turned.as_euler("XYZ", degrees=True))
    return np.asarray(turned.as_euler("ZYX", degrees=True)[::-1])


def _three(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)


def _plain(text: str) -> str:
    return "".join(c if c.isascii() and c.isprintable() and c != "-" else " " for c in text)
