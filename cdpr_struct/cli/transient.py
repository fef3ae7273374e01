"""`cdpr-struct transient`: vibration after an emergency stop, or along a trajectory."""

from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.cable_model import Force, ModelName, read_model, require_valid
from cdpr_struct.cli.damping_option import DampingText, read_damping
from cdpr_struct.cli.degrees_of_freedom import FrameName, PointText, read_ports
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import rest
from cdpr_struct.cli.options import (
    AssemblyName,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Start,
    UpperBound,
    number,
    read_assembly,
    read_numbers,
    read_robot,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.trajectory_input import read_trajectory
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    import numpy as np

    from cdpr_struct.statics.trajectory import Trajectory

NAME = "transient"
EXAMPLES = (
    "cdpr-struct transient thesis-3-1 --initial-velocity 0.3,0,0 --duration 5 --out results/stop",
    "cdpr-struct transient thesis-3-1 --initial-velocity 0,0,0.2 --duration 3 --highest 10 --damping viscous:0.005",
)
_MOST_SAMPLES = 2_000_000
_FEWEST = 4  # rows of a trajectory file, for the rates of its accelerations


def run(
    robot: RobotName,
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    initial_velocity: Annotated[
        str | None,
        typer.Option("--initial-velocity", metavar="VX,VY,VZ[,WX,WY,WZ]", help="Before the stop [m/s, rad/s], world."),
    ] = None,
    trajectory: Annotated[
        str | None, typer.Option("--trajectory", metavar="T", help="CSV file, or helix: vibration along this motion.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option("--duration", parser=number, metavar="S", help="Time to predict [s].")
    ] = None,
    highest: Annotated[
        float, typer.Option("--highest", parser=number, metavar="HZ", help="Modes up to this frequency.")
    ] = 25.0,
    watch: Annotated[
        str | None, typer.Option("--watch", metavar="DOF,..", help="Also record these, like cable5@0.3:z.")
    ] = None,
    window: Annotated[
        float | None, typer.Option("--window", parser=number, metavar="S", help="Spectrogram window [s].")
    ] = None,
    model: ModelName = "exact",
    damping: DampingText = "viscous",
    frame: FrameName = "world",
    at: PointText = None,
    assembly: AssemblyName = "consistent",
    force: Force = False,
    *,
    output: Output,
) -> int:
    """Vibration in time by modal superposition, with spectrogram and certified modes."""
    if (initial_velocity is None) == (trajectory is None):
        raise InputError(
            "--initial-velocity", "", initial_velocity or "nothing", "give either --initial-velocity or --trajectory"
        )
    cable_model, way = read_model(model), read_assembly(assembly)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    law = read_damping(damping, machine, cable_model == "static")
    motion, assumed = (None, []) if trajectory is None else read_trajectory(trajectory, None, _FEWEST)
    seconds = _duration(duration, motion)
    if not 0.0 < highest * seconds * 8.0 < _MOST_SAMPLES:
        raise InputError("--highest", "", highest, f"above zero, with at most {_MOST_SAMPLES} samples (8 per period)")
    if highest * seconds < 1.0:
        raise InputError("--duration", "", seconds, f"at least one period of --highest, {1.0 / highest:.3g} s")
    if motion is not None and pose is None and lengths is None:
        pose = _last_pose(motion)
    state = rest(machine, pose, lengths, start)
    point = state.point
    require_valid(cable_model, point, force)
    ports = read_ports("x,y,z,rx,ry,rz" + (f",{watch}" if watch else ""), "--watch", point, frame, at)
    if window is not None and not 0.0 < window <= seconds:
        raise InputError("--window", "", window, f"a time between 0 and {seconds:g} s")
    from cdpr_struct.dynamics.vibration_record import VibratingRobot
    from cdpr_struct.reports.damping_note import ENDLESS_VIBRATION, damping_note
    from cdpr_struct.reports.transient_result import transient_json
    from cdpr_struct.reports.transient_text import transient_text

    vibrating = VibratingRobot(point, cable_model, law, highest, way)
    with output.steps(1) as progress, state.advised():
        progress("modes and motion")
        if motion is None:
            record = vibrating.after_stop(_twist(initial_velocity or ""), ports, seconds)
        else:
            record = vibrating.along(motion, ports, seconds)
    described = {"damping": damping, "frame": frame, "at_m": at or "0,0,0", "assembly": way}
    described["damping_note"] = damping_note(law, damping, machine, cable_model == "static", ENDLESS_VIBRATION)
    result = transient_json(record, {**described, "command": output.words})
    result |= state.told(*assumed)
    result = with_extensions(result, machine, NAME, cable_model)

    def files() -> Files:
        from cdpr_struct.reports.transient_page import transient_files

        return transient_files(record, result, window)

    output.deliver(result, lambda: transient_text(result), files)
    return 0


def _twist(text: str) -> "np.ndarray":
    import numpy as np

    values = read_numbers(text, "--initial-velocity", (3, 6), "velocities in m/s and rad/s")
    if not any(values):
        raise InputError("--initial-velocity", "", text, "give a velocity that is not zero")
    return np.array([*values, 0.0, 0.0, 0.0][:6])


def _duration(given: float | None, motion: "Trajectory | None") -> float:
    if given is None and motion is not None:
        return float(motion.time[-1] - motion.time[0])
    if given is None:
        raise InputError("--duration", "", "nothing", "give the time to predict in s, like 5")
    if not 0.0 < given < float("inf"):
        raise InputError("--duration", "", given, "give a time in s above zero")
    return given


def _last_pose(motion: "Trajectory") -> str:
    import numpy as np

    from cdpr_struct.robot.pose import angles_from_rotation

    angles = np.degrees(angles_from_rotation(motion.rotation[-1]))
    return ",".join(repr(float(v)) for v in (*motion.position[-1], *angles))
