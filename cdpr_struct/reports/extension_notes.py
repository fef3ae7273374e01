"""What every result says at its end: whether it can be trusted, and which extensions act or why they do not."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.robot.plausibility import implausible

if TYPE_CHECKING:
    from cdpr_struct.robot.robot import Robot

_READINGS = "this describes readings, which only diagnose and plan compare"
_VIBRATION = "this concerns vibration only"
_NO_BENDING = "this cable model has none; --model exact does"
_AT_REST = ("inverse", "forward", "pose-error", "stiffness")
_CABLES_ONLY = ("bending_stiffness", "added_mass")
_INTERNAL, _HEADS, _SWINGS = "internal_mass", "mast_mass", "swinging_mass"
_STIFFENS = ("nonlinearity", "stiffening_exponent")
_ELASTIC = ("series_compliance", "frame_compliance", "mast_bending", *_STIFFENS)


def with_extensions(result: Mapping[str, Any], robot: "Robot", command: str, model: str = "") -> dict[str, Any]:
    """The result, what became of the robot's extensions if it has any, and its constant `wrench` [N, N m] if any.

    result : its `trust`, if any, is a `Trust`; this makes JSON of it and adds what its checks say to `warnings`, behind
             numbers of the robot that can hardly be meant
    model  : cable model of a vibration command, "" if there is no choice
    """
    doubts, trust = implausible(robot), result.get("trust", Trust())
    entered = Check.of("implausible numbers of the robot", len(doubts), 0.0, doubts)
    told = Trust((entered, *trust.checks)).json()
    result = {**result, "trust": told, "warnings": [*doubts, *result.get("warnings", ()), *trust.warnings]}
    active = robot.extensions.active
    if not active:
        return dict(result)
    idle = {name: reason for name in active if (reason := _why_idle(name, command, model))}
    acting = [name for name in active if name not in idle]
    sentences = [f"Extensions of the robot that act: {', '.join(acting) or 'none'}."]
    for reason in dict.fromkeys(idle.values()):
        names = [name for name in idle if idle[name] == reason]
        sentences.append(f"No effect here: {', '.join(names)}; {reason}.")
    sentences += [text for name, text in _particulars(command, model).items() if name in acting]
    said = {"acting": acting, "idle": idle, "sentences": sentences}
    load = robot.extensions.wrench.tolist()
    return {**result, **({"wrench": load} if any(load) else {}), "extensions": said}


def _why_idle(name: str, command: str, model: str) -> str:
    from cdpr_struct.robot.parameters import SENSORS

    if command in ("diagnose", "plan"):
        return ""
    if name in SENSORS:
        return _READINGS
    if name in _OTHERWISE:
        return _OTHERWISE[name](command, model)
    if command == "distribute":
        return "forces are distributed with EA as entered" if name in _STIFFENS else ""
    if name not in _CABLES_ONLY:
        return "inextensible cables on rigid masts know none" if model == "ideal" and name in _ELASTIC else ""
    if command in _AT_REST:
        return _VIBRATION
    if command == "audit":
        return "the printed limits know nothing of it"
    if command == "verify":
        return "the bars of the FEM have none, so this is left out on both sides"
    if model == "fem":
        return "the bars of the FEM have none; use --model exact"
    return _NO_BENDING if model in ("static", "dsm") else ""


def _why_rigid(command: str, model: str) -> str:
    """Why the platform is rigid in a command although a part of it moves in it."""
    if command in (*_AT_REST, "distribute"):
        return _VIBRATION
    if command == "audit":
        return "the printed limits know nothing of it"
    if command == "verify":
        return "the platform of the FEM is rigid, so this is left out on both sides"
    return "the platform of the FEM is rigid; use --model exact" if model == "fem" else ""


def _why_straight(command: str, model: str) -> str:
    """Why wind does not push cables although they have a drag width."""
    del command
    return "straight cables without weight have no drag, either" if model in ("spring", "ideal") else ""


def _why_still(command: str, model: str) -> str:
    """Why what concerns vibration only has no effect in a command: nothing vibrates."""
    return _VIBRATION if command in (*_AT_REST, "distribute", "audit") else ""


def _why_at_rest(command: str, model: str) -> str:
    """Why the stiffness of small motion has no effect in a command."""
    return "" if command == "stiffness" else _why_still(command, model)


_OTHERWISE = {
    "incremental_ratio": _why_at_rest,
    _INTERNAL: _why_rigid,
    _SWINGS: _why_rigid,
    _HEADS: _why_still,
    "drag_width": _why_straight,
}


def _particulars(command: str, model: str) -> dict[str, str]:
    """What is to be known about extensions that act."""
    said = {"tilt": "tilt turns the weight of the platform; that of the cables stays vertical."}
    said["drag_area"] = "Wind acts on the platform as a constant force at its origin."
    said["drag_width"] = "Drag on a cable is that of the wind across its chord, alike on every metre."
    if command == "forward":
        said["drag_width"] += " It has no potential, so energies of other equilibria are not compared."
    if command in ("frf", "transient", "modes", "map", "verify", "audit", "distribute", "spectrogram"):
        said["drag_width"] += " Stiffness and vibration take it as constant; it damps nothing."
    if command == "pose-error":
        said["drag_width"] += " It enters the part of sag: straight cables have none."
    said["moment"] = "moment keeps its axes in the world when the platform turns, so it has no potential."
    if command == "forward":
        said["moment"] += " Energies of other equilibria leave it out."
    if command in ("frf", "transient", "modes", "map", "verify"):
        said["moment"] += " Vibration takes the symmetric part of its stiffness."
    if command in ("frf", "transient", "modes", "map", "distribute"):
        said["added_mass"] = "added_mass takes part in vibration; its weight does not bend the cable."
    if command in ("frf", "transient"):
        said[_INTERNAL] = "The mount of internal_mass has no damping of its own."
        said[_SWINGS] = "The swing of swinging_mass has no damping of its own."
        said[_HEADS] = "Masses on masts have the damping of the cable whose exit they move with."
    if command == "frf":
        still = "For excitation and response at points of cables, masts are taken as rigid."
        said |= {"frame_compliance": still, "mast_bending": still}
    if command == "pose-error":
        wrong = "enters the axial part: spring and sagging cables get the same wrong length."
        said |= {name: f"{name} {wrong}" for name in ("length_offset", "length_scale")}
    return said
