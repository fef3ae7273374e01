"""What the signals of a campaign say of the damping, held against the robot that the diagnosis means."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.amplitude_law import AmplitudeFinding, amplitude_finding
from cdpr_struct.diagnosis.damping_law import DampingFinding, damping_finding
from cdpr_struct.diagnosis.damping_rows import damping_rows, left_out
from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.measurement.signal_states import held_against
from cdpr_struct.robot.robot import Robot

NEEDS_SIGNALS = {
    "viscous_damping": "needs free decays or FRFs",
    "hysteretic_damping": "needs decays at several amplitudes",
    "coulomb_damping": "needs decays at several amplitudes",
}
"""Laws of damping, and what shows them."""


@dataclass(frozen=True, slots=True, eq=False)
class Damped:
    """Identified modes beside those of a robot, the law that damps them, and modes that say nothing of it.

    left_out : case, frequency [Hz] and reason of each
    amplitude : why frequencies change with the amplitude of decays; None where no decay was read in windows
    """

    identified: tuple[Identified, ...]
    finding: DampingFinding
    left_out: tuple[tuple[str, float, str], ...]
    amplitude: AmplitudeFinding | None = None

    @property
    def stands_out(self) -> bool:
        """Whether the damping is not the entered one, and a law is named."""
        return self.finding.status in ("named", "class")

    @property
    def decision(self) -> Decision:
        """Where nothing else is wrong: the laws, as probable as their evidence among all and the entered one."""
        gains = np.array([0.0, *(fit.gain for fit in self.finding.fits)])
        said = [False, *(set(fit.causes) <= set(self.finding.causes) for fit in self.finding.fits)]
        share = np.exp(gains - gains.max())
        probability = float(share[said].sum() / share.sum())
        together = self.finding.status == "named"
        classes = tuple((name,) for name in self.finding.causes) if together else (self.finding.causes,)
        return Decision(self.finding.status, classes, probability)


def damped(campaign: Campaign, robot: Robot | None, loss: Loss | None = None) -> Damped | None:
    """None without signals. `robot` : with its causes, whose modes are damped otherwise; None as entered."""
    if not campaign.identified:
        return None
    identified = campaign.identified
    if robot is not None:
        identified = tuple(held_against(item, robot, campaign.model) for item in identified)
    costs = campaign.loss if loss is None else loss
    finding = damping_finding(damping_rows(identified), campaign.tolerances.damping, costs)
    return Damped(identified, finding, tuple(left_out(identified)), amplitude_finding(identified))
