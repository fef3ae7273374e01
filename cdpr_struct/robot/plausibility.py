"""Numbers of a robot that can hardly be meant: each in a sentence that names the unit it perhaps is in.

Limits are of orders of magnitude, as wrong units are; robots from 1 cm to kilometres, of ropes, wires and fibres, pass.
"""

import numpy as np

from cdpr_struct.robot.robot import Robot

_FAR_OUT = 30.0  # times all other anchors, beyond which one anchor alone cannot be
_WIDE = 5.0  # times the farthest frame anchor, beyond which no platform reaches
_WHEEL = 0.3  # of the farthest frame anchor, beyond which no pulley is
BREAKING_STRAIN = 0.02
"""Elongation over length near which steel ropes break; high-modulus fibres near 0.035."""
_SOFTEST, _STIFFEST = 1e5, 1e9  # of EA over linear density [N m/kg]: ropes of nylon have 1e6, fibres of carbon 1.4e8


def implausible(robot: Robot) -> tuple[str, ...]:
    """Sentences on anchors, pulleys, stiffness and mass of cables that are probably in another unit; () if none."""
    return (*_anchors(robot), *_pulleys(robot), *_cables(robot))


def _reach(robot: Robot) -> float:
    """How far the farthest frame anchor is from the home pose, or from the middle of all [m], without one far out."""
    centre = np.median(robot.frame_anchors, axis=0) if robot.home is None else robot.home.position
    away = np.linalg.norm(robot.frame_anchors - centre, axis=1)
    usual = away[away <= _FAR_OUT * np.median(away)]
    return float(usual.max(initial=0.0))


def _anchors(robot: Robot) -> list[str]:
    home = 0.0 if robot.home is None else float(np.abs(robot.home.position).max())
    size, found = np.abs(robot.frame_anchors).max(axis=1), []
    for i in range(len(size)) if len(size) > 2 else ():
        others = max(float(np.delete(size, i).max()), home)
        if size[i] > _FAR_OUT * others > 0.0:
            where = f"{size[i] / others:.3g} times as far out as all others"
            found.append(f"{_value(i, 'frame_anchor', robot.frame_anchors[i])} lies {where} (is it in mm?).")
    inner, reach = np.linalg.norm(robot.platform_anchors, axis=1), _reach(robot)
    if reach > 0.0 and inner.max() > _WIDE * reach:
        i, times = int(inner.argmax()), inner.max() / reach
        where = f"{times:.3g} times as far from the platform's origin as the frame reaches"
        found.append(f"{_value(i, 'platform_anchor', robot.platform_anchors[i])} lies {where} (is it in mm?).")
    return found


def _value(i: int, name: str, point: np.ndarray) -> str:
    return f"cables[{i + 1}].{name} = [{', '.join(f'{v:g}' for v in point)}] m"


def _pulleys(robot: Robot) -> list[str]:
    radius = np.array([0.0 if pulley is None else pulley.radius for pulley in robot.pulleys])
    reach, i = _reach(robot), int(radius.argmax())
    if not (reach > 0.0 and radius[i] > _WHEEL * reach):
        return []
    beside = f"the frame anchors are within {reach:.3g} m"
    return [f"cables[{i + 1}].pulley.radius = {radius[i]:g} m, and {beside} (is it in mm?)."]


def _cables(robot: Robot) -> list[str]:
    """EA under the platform's weight and the least force, and EA beside the mass."""
    stiff, heavy = robot.axial_stiffness, robot.linear_density
    share = np.maximum(robot.platform.mass * robot.gravity / len(stiff), robot.force_min)
    strain, ratio = share / stiff, stiff / heavy
    i, low, high = int(strain.argmax()), int(ratio.argmin()), int(ratio.argmax())
    if strain[i] > BREAKING_STRAIN:
        by = f"{share[i]:.3g} N, its share of the weight or force_min, stretch it by {100.0 * strain[i]:.3g} %"
        return [f"axial_stiffness = {stiff[i]:g} N of cable {i + 1}: {by} (is it in kN?)."]
    usual = "ropes have 1e6 to 1e8"
    if ratio[low] < _SOFTEST:
        beside = f"linear_density = {heavy[low]:g} kg/m of cable {low + 1} beside EA = {stiff[low]:g} N"
        return [f"{beside}: their ratio is {ratio[low]:.2g} N m/kg, and {usual} (is it in g/m, or EA in kN?)."]
    if ratio[high] > _STIFFEST:
        beside = f"axial_stiffness = {stiff[high]:g} N of cable {high + 1} beside {heavy[high]:g} kg/m"
        return [f"{beside}: their ratio is {ratio[high]:.2g} N m/kg, and {usual} (is it Young's modulus in Pa?)."]
    return []
