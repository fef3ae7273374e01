"""Cable-driven parallel robots: predict deflection and vibration, check the prediction, diagnose measurements.

    import cdpr_struct as cs

    robot = cs.load_robot("thesis-3-1")  # a built-in name, or the path of a robot file
    modes = cs.modes(robot, count=12)
    print(modes)

Functions are named like the commands of `cdpr-struct`, arguments like their options. Every result has `.frame()`
(pandas), `.plot()` (matplotlib axes) and `.to_json()` (the keys of the command's result.json), shows itself in a
terminal and in a notebook, and holds the numerics' own objects. SI units; degrees where a pose is
given by numbers. More: docs/python.md.

Robots:
  load_robot                Robot from a built-in name or a path to a robot file.
  robots                    List the robots that come with the package.
  write_robot               Write a robot to a robot file, which `load_robot` and every command read again, and return
                            its path.
  new_robot                 Make a commented robot file to begin with, of a robot that holds its home pose.
  export                    Make the input file of MoorPy or MoorDyn, or a glTF scene, of a robot at rest.
  Robot                     Cable-driven parallel robot with m cables.
  Platform                  Rigid platform, all in its own frame.
  Cable                     Uniform elastic cable.
  Pulley                    Swivelling pulley at the frame end of a cable.
  Pose                      Pose of the platform frame in the world frame.

Predictions and checks:
  cable                     Describe one cable under an end force: shape, stiffness, validity of the DSM, natural
                            frequencies.
  inverse                   Find the cable lengths and tensions that hold a pose, of least norm where there is a
                            choice.
  forward                   Find the pose that the platform takes at locked cable lengths, and other stable ones.
  pose_error                Compute the static pose error over a grid, split into what sag adds and what stretch adds.
  map                       Map a quantity over a grid of poses, or the workspace: where all requirements hold.
  modes                     Compute the eigenfrequencies of a robot at rest, none missing, with their kind.
  sensitivity               Tell what moves frequencies, pose and tensions of a robot at rest, and what to change for
                            another frequency.
  accept                    Say whether a robot within its tolerances meets requirements: pass, fail, or cannot be
                            said.
  compare                   Compare readings of one state of rest with predictions: each in its band or not, and all
                            of them together.
  frf                       Compute frequency responses, with the certified eigenfrequencies beside their peaks.
  transient                 Predict the vibration after an emergency stop, or along a trajectory, by modal
                            superposition.
  spectrogram               Show measured accelerations over time and frequency, beside the robot's certified
                            eigenfrequencies.
  verify                    Compare eigenfrequencies of the exact model and the DSM with those of the FEM; `holds` if
                            they agree.
  audit                     Check each cable at each pose against the printed validity limits of the closed form;
                            `valid`: none is broken.
  limits                    Try the printed validity limits themselves against the catenary and the FEM (`audit
                            --limits`).
  distribute                Distribute cable forces of least cost along a trajectory, above a lower bound.
  ambient                   Identify natural frequencies and damping ratios in a campaign's records of vibration under
                            unknown forces.
  reproduce                 Recompute tables and figures of the thesis and show the deviations.

Measured data:
  new_campaign              Make a campaign file and data files with the planned poses and what the simulation
                            predicts, to be filled.
  import_recording          Make a campaign of a recording (ROS bag, MCAP, TDMS, MDF, .mat, .xlsx, CSV) and a mapping
                            of its channels.
  recording_channels        List the channels of a recording (bag, MCAP, TDMS, MDF, .mat, .xlsx, CSV), with a mapping
                            file to fill in.
  load_campaign             Read a campaign file and the data files it names, all checked.
  causes                    List the causes that a diagnosis looks for, by name, those of installed packages among
                            them.
  diagnose                  Name the cause of differences between a simulation and measured data.
  plan                      Tell before measuring which causes a campaign can find, which it confuses, and what to
                            measure next.
  Campaign                  A measuring campaign and the simulation under test.

Values:
  Grid                      Every combination of positions x, y, z at one orientation.
  Trajectory                Motion of the platform frame at k instants, world axes.
  Result                    An answer of this package, which shows itself as text, table, figure and JSON.

Errors:
  CdprError                 What this package raises on purpose; if it is no `InputError`, the request is well-posed
                            but cannot be met.
  InputError                Unusable input: where it is, what it was, and what would be right.
  UnholdablePoseError       No tension distribution above the lower bound balances the load at this pose.
  UnstableEquilibriumError  The platform is balanced, but a small motion would grow: there are no vibrations about
                            this state.
  ConvergenceError          An iteration stopped before it converged; holds the last residual.
  OutsideValidityError      The closed-form DSM is asked for cables outside its printed limits.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cdpr_struct.crosscheck.robot_modes import OutsideValidityError
    from cdpr_struct.errors import (
        CdprError,
        ConvergenceError,
        InputError,
        UnholdablePoseError,
        UnstableEquilibriumError,
    )
    from cdpr_struct.interface.accept import accept
    from cdpr_struct.interface.ambient import ambient
    from cdpr_struct.interface.audit import audit
    from cdpr_struct.interface.cable import cable
    from cdpr_struct.interface.campaigns import causes, load_campaign
    from cdpr_struct.interface.compare import compare
    from cdpr_struct.interface.diagnose import diagnose
    from cdpr_struct.interface.distribute import distribute
    from cdpr_struct.interface.export import export
    from cdpr_struct.interface.forward import forward
    from cdpr_struct.interface.frf import frf
    from cdpr_struct.interface.import_recording import import_recording, recording_channels
    from cdpr_struct.interface.inverse import inverse
    from cdpr_struct.interface.limits import limits
    from cdpr_struct.interface.map import map
    from cdpr_struct.interface.modes import modes
    from cdpr_struct.interface.new_campaign import new_campaign
    from cdpr_struct.interface.new_robot import new_robot
    from cdpr_struct.interface.plan import plan
    from cdpr_struct.interface.pose_error import pose_error
    from cdpr_struct.interface.reproduce import reproduce
    from cdpr_struct.interface.result import Result
    from cdpr_struct.interface.robots import robots, write_robot
    from cdpr_struct.interface.sensitivity import sensitivity
    from cdpr_struct.interface.spectrogram import spectrogram
    from cdpr_struct.interface.transient import transient
    from cdpr_struct.interface.verify import verify
    from cdpr_struct.measurement.campaign import Campaign
    from cdpr_struct.robot.cable import Cable, Pulley
    from cdpr_struct.robot.platform import Platform
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.robot.robot_file import load_robot
    from cdpr_struct.statics.trajectory import Trajectory
    from cdpr_struct.workspace.grid import Grid

_HOMES = {
    "robot.robot_file": ("load_robot",),
    "interface.robots": ("robots", "write_robot"),
    "interface.new_robot": ("new_robot",),
    "interface.new_campaign": ("new_campaign",),
    "interface.import_recording": ("import_recording", "recording_channels"),
    "interface.cable": ("cable",),
    "interface.inverse": ("inverse",),
    "interface.forward": ("forward",),
    "interface.pose_error": ("pose_error",),
    "interface.map": ("map",),
    "interface.modes": ("modes",),
    "interface.sensitivity": ("sensitivity",),
    "interface.accept": ("accept",),
    "interface.compare": ("compare",),
    "interface.frf": ("frf",),
    "interface.transient": ("transient",),
    "interface.spectrogram": ("spectrogram",),
    "interface.verify": ("verify",),
    "interface.audit": ("audit",),
    "interface.limits": ("limits",),
    "interface.distribute": ("distribute",),
    "interface.export": ("export",),
    "interface.campaigns": ("load_campaign", "causes"),
    "interface.ambient": ("ambient",),
    "interface.diagnose": ("diagnose",),
    "interface.plan": ("plan",),
    "interface.reproduce": ("reproduce",),
    "robot.robot": ("Robot",),
    "robot.platform": ("Platform",),
    "robot.cable": ("Cable", "Pulley"),
    "robot.pose": ("Pose",),
    "workspace.grid": ("Grid",),
    "statics.trajectory": ("Trajectory",),
    "measurement.campaign": ("Campaign",),
    "interface.result": ("Result",),
    "errors": ("CdprError", "InputError", "UnholdablePoseError", "UnstableEquilibriumError", "ConvergenceError"),
    "crosscheck.robot_modes": ("OutsideValidityError",),
}
"""Modules that public names come from when they are first asked for: importing this package loads nothing else."""
_HOME = {name: f"cdpr_struct.{module}" for module, names in _HOMES.items() for name in names}

__all__ = [
    "Cable",
    "Campaign",
    "CdprError",
    "ConvergenceError",
    "Grid",
    "InputError",
    "OutsideValidityError",
    "Platform",
    "Pose",
    "Pulley",
    "Result",
    "Robot",
    "Trajectory",
    "UnholdablePoseError",
    "UnstableEquilibriumError",
    "__version__",
    "accept",
    "ambient",
    "audit",
    "cable",
    "causes",
    "compare",
    "diagnose",
    "distribute",
    "export",
    "forward",
    "frf",
    "import_recording",
    "inverse",
    "limits",
    "load_campaign",
    "load_robot",
    "map",
    "modes",
    "new_campaign",
    "new_robot",
    "plan",
    "pose_error",
    "recording_channels",
    "reproduce",
    "robots",
    "sensitivity",
    "spectrogram",
    "transient",
    "verify",
    "write_robot",
]


def __getattr__(name: str) -> Any:
    """A public name, loaded when it is first asked for."""
    if name == "__version__":
        from importlib.metadata import version

        return version("cdpr-struct")
    if name not in _HOME:
        raise AttributeError(f"module 'cdpr_struct' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    """What is there already, and all public names."""
    return sorted({*globals(), *__all__})
