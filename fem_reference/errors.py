"""Every way the finite-element referee can refuse an answer, each with its numbers and the next step."""

from __future__ import annotations

import numpy as np


class FemError(Exception):
    """Family of all refusals of this package; a bad argument is a ValueError instead."""


class CableNotConvergedError(FemError):
    """The static iteration of a cable stopped before it was in equilibrium."""

    def __init__(self, cable: int, closure: float, iterations: int, mid_force: np.ndarray) -> None:
        self.cable, self.closure, self.iterations = cable, closure, iterations
        self.mid_force = np.array(mid_force)
        super().__init__(
            f"cable {cable}: the chain misses its end by {closure:.3g} m after {iterations} iterations "
            f"(tension at mid-length {np.linalg.norm(mid_force):.4g} N). "
            "Check that the cable has weight or is longer than nothing, and that its data are in SI units."
        )


class FoldedCableError(FemError):
    """A slack cable folds inside one element: a bar there would carry no tension, so has no direction."""

    def __init__(self, cable: int, element: int, tension: float, largest: float) -> None:
        self.cable, self.element, self.tension, self.largest = cable, element, tension, largest
        super().__init__(
            f"cable {cable}: element {element} carries {tension:.3g} N while the cable carries up to "
            f"{largest:.3g} N: the slack cable folds there. "
            "Move the ends apart sideways, take more elements, or shorten the cable."
        )


class CompressedBarError(FemError):
    """A bar of a supposed equilibrium is shorter than its unstrained length."""

    def __init__(self, cable: int, element: int, tension: float) -> None:
        self.cable, self.element, self.tension = cable, element, tension
        super().__init__(
            f"cable {cable}: element {element} carries {tension:.4g} N; a cable cannot push. "
            "Shorten the cable, or give it weight to hang by."
        )


class RobotNotConvergedError(FemError):
    """The search for the platform pose stopped before forces and moments balanced."""

    def __init__(
        self,
        residual_wrench: np.ndarray,
        tolerance: float,
        iterations: int,
        position: np.ndarray,
        rotation: np.ndarray,
    ) -> None:
        self.residual_wrench, self.iterations = np.array(residual_wrench), iterations
        self.position, self.rotation = np.array(position), np.array(rotation)
        force, moment = np.linalg.norm(residual_wrench[:3]), np.linalg.norm(residual_wrench[3:])
        super().__init__(
            f"platform out of balance by {force:.3g} N and {moment:.3g} N m after {iterations} iterations "
            f"(tolerance {tolerance:.3g} N) at position {np.round(position, 6).tolist()} m. "
            "Start nearer to the expected pose, or check the unstrained lengths."
        )


class UnstableEquilibriumError(FemError):
    """The stiffness has a negative direction, so that frequency is not a real number."""

    def __init__(self, eigenvalue: float) -> None:
        self.eigenvalue = eigenvalue
        super().__init__(
            f"smallest eigenvalue omega^2 = {eigenvalue:.4g} rad^2/s^2 is negative: the state is unstable. "
            "Solve the statics with hold_pose=False first, or raise the cable tensions."
        )


class MissedModesError(FemError):
    """The eigensolver returned another number of modes than the inertia of the matrix says there are."""

    def __init__(self, found: int, counted: int, frequency_hz: float) -> None:
        self.found, self.counted, self.frequency_hz = found, counted, frequency_hz
        super().__init__(
            f"{found} modes found below {frequency_hz:.6g} Hz, but the sign count says {counted} "
            "(-1 found: frequencies too close together to count between). "
            "Ask for a few modes more; if it persists, report the case."
        )


class UndefinedSwivelError(FemError):
    """The cable comes straight back along the swivel axis, so its pulley has no plane."""

    def __init__(self, entry: np.ndarray, axis: np.ndarray) -> None:
        self.entry, self.axis = np.array(entry), np.array(axis)
        super().__init__(
            f"the cable at {np.round(entry, 6).tolist()} m comes back along its swivel axis "
            f"{np.round(axis, 6).tolist()}: the pulley may face any way. "
            "Move the platform off the axis, or turn the axis around if it should point where the cable goes."
        )


class PulleysNotSettledError(FemError):
    """The exit points of the cables kept moving on their pulleys."""

    def __init__(self, moved: float, iterations: int) -> None:
        self.moved, self.iterations = moved, iterations
        super().__init__(
            f"exit points still move by {moved:.3g} m after {iterations} rounds of statics. "
            "The pulleys are large beside the cables or the platform hangs near a swivel axis: "
            "move it away, or take smaller radii."
        )


class MastsNotSettledError(FemError):
    """The heads of the masts kept moving under their cables."""

    def __init__(self, moved: float, iterations: int) -> None:
        self.moved, self.iterations = moved, iterations
        super().__init__(
            f"heads of masts still move by {moved:.3g} m after {iterations} rounds of statics. "
            "The masts give way too much for these cables: check their compliance [m/N]."
        )


class WindNotSettledError(FemError):
    """The wind on the cables kept changing with the pose."""

    def __init__(self, iterations: int) -> None:
        self.iterations = iterations
        super().__init__(
            f"the wind on the cables still changes after {iterations} rounds of statics. "
            "It is too strong for this robot to rest in: take less wind, or more tension."
        )


class StepNotConvergedError(FemError):
    """The equations of motion of one time step were not solved."""

    def __init__(self, time: float, residual: float, tolerance: float, iterations: int) -> None:
        self.time, self.residual, self.tolerance, self.iterations = time, residual, tolerance, iterations
        super().__init__(
            f"time step ending at {time:.6g} s is out of balance by {residual:.3g} N after {iterations} iterations "
            f"(tolerance {tolerance:.3g} N). Take a smaller time_step."
        )
