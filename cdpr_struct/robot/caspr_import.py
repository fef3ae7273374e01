"""Robot files from CASPR models (bodies and cables in XML).

CASPR describes one or more rigid links, numbered from 1; link 0 is the frame. `attachment_reference` says whether
attachment points on a link count from its joint or from its centre of mass; the stiffness K of a linear-spring cable is
EA (CASPR divides it by the length). The format has no linear density.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.robot.caspr_cables import CableEnds, cable_ends
from cdpr_struct.robot.caspr_xml import attribute, child, numbers, parse, value
from cdpr_struct.robot.pose import angles_from_rotation

ASSUMED_AXIAL_STIFFNESS = 251327.4123  # N, 4 mm steel cable of the thesis, E = 20 GPa
ASSUMED_DENSITY = 0.067  # kg/m, the same cable
_SIX_DOF = "SPATIAL_EULER_XYZ"
_PLANAR = {"PLANAR_XY": ("z", "rx", "ry"), "PLANAR_XZ": ("y", "rx", "rz"), "PLANAR_YZ": ("x", "ry", "rz")}
"""Joints of a platform in a plane, and what a guide then holds."""


@dataclass(frozen=True, slots=True)
class Choices:
    """What the user adds to the files.

    axial_stiffness, linear_density : of every cable [N], [kg/m], or None
    cable_set : its id, or None for the file's default
    inertia   : Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the centre of mass, entries of the matrix [kg m^2], or None
    """

    axial_stiffness: float | None = None
    linear_density: float | None = None
    cable_set: str | None = None
    inertia: Sequence[float] | None = None


@dataclass(frozen=True, slots=True)
class ImportedRobot:
    """text : the robot file;  warnings : what to check before use, one sentence each"""

    name: str
    cables: int
    text: str
    warnings: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class _Body:
    name: str
    mass: float
    center: np.ndarray
    inertia: np.ndarray
    home: np.ndarray | None
    guided: tuple[str, ...] = ()


def import_caspr(bodies: str, cables: str, bodies_name: str, cables_name: str, choices: Choices) -> ImportedRobot:
    """Robot file of a CASPR model with one platform.

    Parameters
    ----------
    bodies, cables : text of the two XML files;  bodies_name, cables_name : what messages call them

    Raises
    ------
    InputError : not XML, an element that is missing or no number, more than one moving link, a cable that is not one
        straight segment from the frame to the platform, or an inertia that no body has.
    """
    warnings: list[str] = []
    body = _body(parse(bodies, bodies_name), bodies_name, choices, warnings)
    root = parse(cables, cables_name)
    ends = cable_ends(root, cables_name, choices.cable_set, body.center, warnings)
    stiffness = _stiffness(ends, choices, warnings)
    if choices.linear_density is None:
        warnings.append(
            f"the format has no linear density: {ASSUMED_DENSITY} kg/m is ASSUMED (4 mm steel cable). Give --rho."
        )
    density = choices.linear_density or ASSUMED_DENSITY
    text = _toml(body, ends, stiffness, density, (bodies_name, cables_name), warnings)
    return ImportedRobot(body.name, len(ends), text, tuple(warnings))


# ---- bodies


def _body(root: ElementTree.Element, source: str, choices: Choices, warnings: list[str]) -> _Body:
    links = root.findall(".//link_rigid")
    if not links and root.find(".//cable_set") is not None:
        raise InputError(source, "", "a file of cables", "the file of the bodies here: give that of the bodies first")
    if len(links) != 1:
        raise InputError(source, "links", f"{len(links)} rigid links", "a model with exactly one, the platform")
    link = links[0]
    physical = child(link, "physical", source)
    mass = value(physical, "mass", source)
    if not mass > 0.0:
        raise InputError(source, "physical.mass", mass, "a mass in kg above zero")
    center = numbers(physical, "com_location", source, 3)
    if np.abs(center).max() > 0.0:
        warnings.append(
            f"the centre of mass lies {np.linalg.norm(center):.4g} m off the platform origin, at {_list(center)} m. "
            "Payloads act at the origin."
        )
    inertia = _inertia(physical, source, mass, center, choices, warnings)
    name = link.get("name") or "caspr-robot"
    guided = _PLANAR.get(child(link, "joint", source).get("type") or "", ())
    return _Body(name, mass, center, inertia, _home(link, source, warnings), guided)


def _inertia(
    physical: ElementTree.Element, source: str, mass: float, center: np.ndarray, choices: Choices, warnings: list[str]
) -> np.ndarray:
    """About the centre of mass; checked to be that of a body."""
    if choices.inertia is not None:
        matrix = _symmetric(choices.inertia)
        _check_inertia(matrix, "--inertia", "")
        return matrix
    element = child(physical, "inertia", source)
    entries = [value(element, name, source) for name in ("Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz")]
    matrix = _symmetric(entries)
    reference = attribute(element, "ref", source, ("com", "joint"))
    if reference == "joint":
        matrix = matrix - mass * (center @ center * np.eye(3) - np.outer(center, center))
        warnings.append("the inertia is given about the joint; it was moved to the centre of mass.")
    _check_inertia(matrix, source, "physical.inertia")
    if any(entries[3:]):
        warnings.append(_products_warning(matrix))
    return matrix


def _products_warning(matrix: np.ndarray) -> str:
    """What the sign convention of the products of inertia decides; it cannot be read from the file."""
    other = 2.0 * np.diag(np.diag(matrix)) - matrix
    as_entries, as_integrals = np.linalg.eigvalsh(matrix), np.linalg.eigvalsh(other)
    gap = as_integrals[0] + as_integrals[1] - as_integrals[2]
    impossible = " (which no body has)" if as_integrals[0] <= 0.0 or gap < 0.0 else ""
    return (
        "the products of inertia are taken as entries of the matrix, principal moments "
        f"{_few(as_entries)} kg m^2; programs that export integrals of x y need the opposite sign, principal moments "
        f"{_few(as_integrals)} kg m^2{impossible}. Give --inertia to replace them."
    )


def _check_inertia(matrix: np.ndarray, source: str, field: str) -> None:
    principal = np.linalg.eigvalsh(matrix)
    if principal[0] <= 0.0 or principal[0] + principal[1] < principal[2] * (1.0 - 1e-9):
        expected = (
            "principal moments of a body: positive, and the two smaller sum to at least the largest (triangle "
            "inequality). Check the products of inertia, or give --inertia IXX,IYY,IZZ,IXY,IXZ,IYZ"
        )
        raise InputError(source, field, f"principal moments {_few(principal)} kg m^2", expected)


def _symmetric(entries: Sequence[float]) -> np.ndarray:
    xx, yy, zz, xy, xz, yz = entries
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _home(link: ElementTree.Element, source: str, warnings: list[str]) -> np.ndarray | None:
    """x, y, z, rx, ry, rz [m, deg] in our order of rotations, from the joint's initial value."""
    joint = child(link, "joint", source)
    kind = joint.get("type") or "nothing"
    if kind in _PLANAR:
        held = ", ".join(_PLANAR[kind])
        warnings.append(f"joint type {kind}: a guide holds {held} of the platform; no home pose was read.")
        return None
    if kind != _SIX_DOF:
        warnings.append(
            f"joint type {kind}: taken as a free platform with six degrees of freedom, and no home pose was read "
            f"(only {_SIX_DOF} is)."
        )
        return None
    text = joint.get("q_initial")
    if text is None:
        return None
    try:
        q = np.array([float(part) for part in text.split()])
    except ValueError as error:
        raise InputError(source, "joint.q_initial", text, "six numbers x y z and angles in rad") from error
    if q.shape != (6,) or not np.isfinite(q).all():
        raise InputError(source, "joint.q_initial", text, "six numbers x y z and angles in rad")
    parent = link.find("parent")
    base = np.zeros(3) if parent is None else numbers(parent, "location", source, 3)
    warnings.append(
        f"{_SIX_DOF} means R = Rx Ry Rz; robot files have R = Rz Ry Rx. The home pose was converted; convert angles of "
        "CASPR trajectories the same way."
    )
    return np.concatenate([base + q[:3], np.degrees(angles_from_rotation(_rotation_xyz(q[3:])))])


def _rotation_xyz(angles: np.ndarray) -> np.ndarray:
    """R = Rx Ry Rz of three angles [rad]."""
    turns = []
    for axis, angle in enumerate(angles):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[i, i] = turn[j, j] = np.cos(angle)
        turn[i, j], turn[j, i] = -np.sin(angle), np.sin(angle)
        turns.append(turn)
    return turns[0] @ turns[1] @ turns[2]


# ---- cables


def _stiffness(ends: list[CableEnds], choices: Choices, warnings: list[str]) -> list[float]:
    """EA of each cable: the user's, else the file's, else assumed."""
    if choices.axial_stiffness is not None:
        return [choices.axial_stiffness] * len(ends)
    if any(cable.stiffness is None for cable in ends):
        warnings.append(
            f"cables without stiffness: EA = {ASSUMED_AXIAL_STIFFNESS:g} N is ASSUMED (4 mm steel cable). Give --EA."
        )
    return [ASSUMED_AXIAL_STIFFNESS if cable.stiffness is None else cable.stiffness for cable in ends]


# ---- robot file


def _toml(
    body: _Body,
    ends: list[CableEnds],
    stiffness: list[float],
    density: float,
    sources: tuple[str, str],
    warnings: list[str],
) -> str:
    lines = [f"# Imported from the CASPR model {_plain(sources[0])}, {_plain(sources[1])}."]
    lines += [f"# CHECK: {_plain(warning)}" for warning in warnings]
    lines += [
        f'name = "{_plain(body.name)}"',
        f'description = "imported from CASPR, {len(ends)} cables"',
        "gravity = 9.81",
    ]
    if body.home is not None:
        lines.append(f"home_pose = {_list(body.home)}")
    rows = ", ".join(_list(row) for row in body.inertia)
    lines += [
        "",
        "[platform]",
        f"mass = {body.mass!r}",
        f"center_of_mass = {_list(body.center)}",
        f"inertia = [{rows}]",
        *([f"guided = {list(body.guided)}".replace("'", '"')] if body.guided else []),
    ]
    alike = len({(cable.force_min, cable.force_max) for cable in ends}) == 1
    lines += ["", "[cable]", f"linear_density = {density!r}", "damping_ratio = 0.01"]
    lines += ends[0].limit_lines() if alike else []
    for i, (cable, ea) in enumerate(zip(ends, stiffness, strict=True), start=1):
        lines += ["", f"[[cables]]  # {i}", f"platform_anchor = {_list(cable.platform)}"]
        lines += [f"frame_anchor = {_list(cable.frame)}", f"axial_stiffness = {ea!r}"]
        lines += [] if alike else cable.limit_lines()
        if cable.pulley is not None:
            lines.append(f"pulley = {{ radius = {cable.pulley.radius!r}, axis = {_list(cable.pulley.axis)} }}")
    return "\n".join(lines) + "\n"


def _list(values: np.ndarray) -> str:
    return "[" + ", ".join(repr(round(float(v), 12) + 0.0) for v in values) + "]"


def _few(values: np.ndarray) -> str:
    """Numbers to be looked at: four digits."""
    return "[" + ", ".join(f"{v:.4g}" for v in values) + "]"


def _plain(text: str) -> str:
    """Text without what would end a TOML string or comment."""
    return "".join(c if c.isprintable() and c not in '"\\' else " " for c in text)
