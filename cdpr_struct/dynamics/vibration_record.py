"""A predicted vibration with everything that is needed to read it: the robot, its ports and its modes."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, CableModel, cable_dynamics
from cdpr_struct.dynamics.damping import Damping
from cdpr_struct.dynamics.frequency_sweep import ModesInBand, modes_below
from cdpr_struct.dynamics.modal_basis import ModalBasis, modal_basis
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import Port
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.rubbing_motion import EndFriction, RubbingEnds, rubbing_vibration
from cdpr_struct.dynamics.transient import Vibration, after_stop, along_path
from cdpr_struct.errors import CdprError
from cdpr_struct.statics.trajectory import Trajectory

SAMPLES_PER_PERIOD = 8  # of the fastest mode that is kept
MOST_MODES = 1000


@dataclass(frozen=True, slots=True, eq=False)
class VibrationRecord:
    """What sensors at the ports would record.

    highest_hertz : modes up to this frequency were superposed
    nominal       : (n, 6) acceleration of the nominal motion, zero after a stop [m/s^2, rad/s^2], world axes
    modes         : eigenfrequencies up to `highest_hertz`
    """

    point: OperatingPoint
    model: CableModel
    ports: tuple[Port, ...]
    highest_hertz: float
    vibration: Vibration
    nominal: np.ndarray
    modes: ModesInBand


@dataclass(frozen=True, slots=True, eq=False)
class VibratingRobot:
    """A robot at rest and what its vibration is computed with; `friction` at the ends of its cables, or None."""

    point: OperatingPoint
    model: CableModel
    law: Damping
    highest_hertz: float
    assembly: Assembly = "consistent"
    friction: EndFriction | None = None

    def after_stop(self, twist: np.ndarray, ports: tuple[Port, ...], duration: float) -> VibrationRecord:
        """Free vibration for `duration` [s] after the velocity `twist` (6,) was stopped."""
        time = self._instants(duration)
        cables, basis = self._modes()
        return self._record(cables, ports, self._stopped(basis, twist, ports, time), np.zeros((len(time), 6)))

    def along(self, motion: Trajectory, ports: tuple[Port, ...], duration: float) -> VibrationRecord:
        """Vibration for `duration` [s] from the beginning of the motion; a motion that ends moving is stopped there."""
        time = self._instants(duration)
        cables, basis = self._modes()
        return self._record(cables, ports, *self._driven(basis, motion, ports, time))

    def motion(self, cause: np.ndarray | Trajectory, ports: tuple[Port, ...], duration: float) -> Vibration:
        """The same of a velocity that is stopped or of a motion, without what it takes to read it."""
        time, basis = self._instants(duration), self._modes()[1]
        if isinstance(cause, Trajectory):
            return self._driven(basis, cause, ports, time)[0]
        return self._stopped(basis, cause, ports, time)

    def _stopped(self, basis: ModalBasis, twist: np.ndarray, ports: tuple[Port, ...], time: np.ndarray) -> Vibration:
        if self.friction is None:
            return after_stop(basis, twist, ports, time)
        ends = RubbingEnds.of(self.point, basis, self.friction)
        return rubbing_vibration(basis, ends, np.zeros((len(time), 6)), (0, twist), ports, time)

    def _driven(
        self, basis: ModalBasis, motion: Trajectory, ports: tuple[Port, ...], time: np.ndarray
    ) -> tuple[Vibration, np.ndarray]:
        """The vibration, and the acceleration (n, 6) of the nominal motion."""
        own = motion.time - motion.time[0]
        given = np.concatenate([motion.acceleration, motion.angular_acceleration], axis=1)
        nominal = np.stack([np.interp(time, own, column, right=0.0) for column in given.T], axis=1)
        stop = int(np.searchsorted(time, own[-1] - 1e-9 * own[-1]))
        last = np.concatenate([motion.velocity[-1], motion.angular_velocity[-1]])
        taken = last if stop < len(time) else 0.0 * last
        if self.friction is None:
            return along_path(basis, nominal, taken, stop, ports, time), nominal
        ends = RubbingEnds.of(self.point, basis, self.friction)
        return rubbing_vibration(basis, ends, nominal, (stop, taken), ports, time), nominal

    def _instants(self, duration: float) -> np.ndarray:
        rate = SAMPLES_PER_PERIOD * self.highest_hertz
        return np.arange(int(duration * rate * (1.0 + 1e-12)) + 1) / rate

    def _modes(self) -> tuple[CableDynamics, ModalBasis]:
        highest = 2.0 * np.pi * self.highest_hertz
        cables = cable_dynamics(self.point, self.model, highest)
        count = int(count_below(self.point, cables, np.array([highest]), self.assembly)[0])
        if not 1 <= count <= MOST_MODES:
            raise CdprError(
                f"the robot has {count} modes up to {self.highest_hertz:g} Hz; choose the frequency so that there are "
                f"1 to {MOST_MODES}"
            )
        return cables, modal_basis(self.point, cables, self.law, count, highest, self.assembly)

    def _record(
        self, cables: CableDynamics, ports: tuple[Port, ...], vibration: Vibration, nominal: np.ndarray
    ) -> VibrationRecord:
        modes = modes_below(self.point, cables, self.highest_hertz, self.assembly)
        return VibrationRecord(self.point, self.model, ports, self.highest_hertz, vibration, nominal, modes)
