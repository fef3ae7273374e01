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
_THINNEST = 1e-3  # [kg/m^3], platform's mass over its radius cubed: a thousandth of air
_FARTHEST = 2e4  # reach of the frame over the platform's radius of gyration
_HEAVIEST = 30.0  # weight of all cables over the platform's
_LARGE = 100.0  # [m], reach of the frame from which on that weight is a sign of mm
_OUTSIDE = 30.0  # home pose from the middle of the frame, in sizes of the frame
_DEEPEST = 3e3  # [m] below it, which a hoist in a shaft reaches


def implausible(robot: Robot) -> tuple[str, ...]:
    """Sentences on lengths, home pose, anchors, pulleys and cables that are probably in another unit; () if none."""
    whole = lengths_in_mm(robot)
    return (*([whole] if whole else []), *_home(robot), *_anchors(robot), *_pulleys(robot), *_cables(robot))


def lengths_in_mm(robot: Robot) -> str:
    """A sentence on a robot whose lengths are all in mm, as its masses tell; "" if they are not.

    All lengths alike a thousand times too large leave its shape as it is. What remains is the platform: thinner than
    air, with all its mass in its middle, or nothing beside its cables.
    """
    body, reach = robot.platform, _reach(robot)
    middle = np.median(robot.platform_anchors, axis=0)
    inner = float(np.median(np.linalg.norm(robot.platform_anchors - middle, axis=1)))
    gyration = float(np.sqrt(np.trace(body.inertia) / (2.0 * body.mass)))
    cables = float(robot.linear_density.sum() * reach)
    far = f"The frame's anchors lie up to {reach:.4g} m away"
    if inner > 0.0 and body.mass < _THINNEST * inner**3:
        return f"{far}, and {body.mass:.4g} kg fill a platform of {inner:.4g} m in radius (are the lengths in mm?)."
    if reach > _FARTHEST * gyration:
        return f"{far}, and the platform's radius of gyration is {gyration:.2g} m (are the lengths in mm?)."
    if robot.gravity > 0.0 and reach > _LARGE and cables > _HEAVIEST * body.mass:
        return f"{far}: cables of that length weigh {cables:.3g} kg, the platform {body.mass:.4g} kg (is it in mm?)."
    return ""


def _home(robot: Robot) -> list[str]:
    """A home pose far outside of the frame; below it hang lifts."""
    middle = np.median(robot.frame_anchors, axis=0)
    size = float(np.linalg.norm(robot.frame_anchors - middle, axis=1).max())
    if robot.home is None or not size > 0.0:
        return []
    away = robot.home.position - middle
    down = max(float(away @ robot.down), 0.0)
    beside = float(np.linalg.norm(away - down * robot.down))
    if beside <= _OUTSIDE * size and down <= max(_OUTSIDE * size, _DEEPEST):
        return []
    place = ", ".join(f"{v:g}" for v in robot.home.position)
    where = f"{np.linalg.norm(away):.4g} m from the middle of the frame, whose anchors are within {size:.3g} m of it"
    return [f"home_pose = [{place}] m lies {where} (is it in mm?)."]


def _reach(robot: Robot) -> float:
    """How far the farthest frame anchor is from the home pose, or from the middle of all [m], without one far out."""
    centre = np.median(robot.frame_anchors, axis=0) if robot.home is None or _home(robot) else robot.home.position
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
    named = odd_ratio(stiff[low], heavy[low], f"cable {low + 1}") or odd_ratio(
        stiff[high], heavy[high], f"cable {high + 1}"
    )
    return [named] if named else []


def odd_ratio(axial_stiffness: float, linear_density: float, whose: str) -> str:
    """A sentence on EA [N] and mass per length [kg/m] that no rope has beside each other; "" if they are plausible."""
    ratio, usual = axial_stiffness / linear_density, "ropes have 1e6 to 1e8"
    if ratio < _SOFTEST:
        beside = f"linear_density = {linear_density:g} kg/m of {whose} beside EA = {axial_stiffness:g} N"
        return f"{beside}: their ratio is {ratio:.2g} N m/kg, and {usual} (is it in g/m, or EA in kN?)."
    if ratio > _STIFFEST:
        beside = f"axial_stiffness = {axial_stiffness:g} N of {whose} beside {linear_density:g} kg/m"
        return f"{beside}: their ratio is {ratio:.2g} N m/kg, and {usual} (is it Young's modulus in Pa?)."
    return ""
