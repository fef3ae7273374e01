"""Further measurements in words."""

import numpy as np

from cdpr_struct.measurement.campaign import Sigmas
from cdpr_struct.planning.measurements import CABLE_MODES, Measurement
from cdpr_struct.planning.places import TILT
from cdpr_struct.planning.recommendations import Recommendation

MANY = 50.0  # nats beyond which the number says nothing more
CHECKS = {
    "platform_mass": "weigh the platform (+-0.1 kg)",
    "joint_mass": "weigh the joints (+-0.01 kg)",
    "sensor_mass": "weigh sensors and shaker (+-0.05 kg)",
    "linear_density": "weigh 5 m of cable (+-0.5 %)",
    "axial_stiffness": "tensile test of 2 m of cable (+-1 %)",
    "center_of_mass": "balance the platform on an edge (+-2 mm)",
    "inertia": "measure the platform inertia as a bifilar pendulum (+-2 %)",
    "tilt": "spirit level on the frame (+-0.5 mrad)",
    "platform_anchors": "measure the platform anchors with a caliper (+-0.2 mm)",
    "frame_anchors": "survey the frame anchors with a laser tracker (+-0.5 mm)",
    "load_cells": "hang two known weights on each load cell (+-1 N)",
    "length_offset": "home all winches again (+-0.5 mm)",
    "tracker": "measure common points on the frame with the tracker (+-0.2 mm, mrad)",
    "pulley_radius": "measure the pulleys with a caliper (+-0.1 mm)",
    "hose": "spring balance on hoses and wires (+-1 N/m)",
    "force": "spring balance on the free platform (+-1 N)",
    "masts": "dial gauge on every mast (+-0.1 um/N)",
    "joint_compliance": "dial gauge across the joints (+-0.1 um/N)",
    "temperature": "thermometer (+-1 K)",
    "drum_scale": "encoder count over a measured metre (+-0.2 mm)",
}
"""By name of the check, with its one sigma."""
_KINDS = {
    "pose": "static state at {at}",
    "tilt": "static state at {at} turned to {turned}",
    "payload": "static state with a payload of {loads} kg at {at}",
    "approach": "the state at {at} again, approached from the other side",
    "encoders": "the state at {at} again with encoder lengths to {length:g} mm",
    "cable_frequencies": "frequencies 1 to {modes} of every cable at {at}",
    "robot_frequencies": "robot frequencies at {at}",
    "locked": "poses at locked lengths with {loads} kg, tracked to {position:g} mm",
    "clamped": "clamp the cables at their exits, then track poses with {loads} kg to {position:g} mm",
    "tilts": "{count} poses tilted by {tilt:.0f} deg",
    "poses": "{count} poses up to {apart:.1f} m apart",
    "payloads": "a payload series of {loads} kg at one pose",
    "sides": "{count} of the poses again, approached from the other side",
}


def measurement_text(what: Measurement) -> str:
    """What to do."""
    if what.kind == "check":
        return CHECKS[what.check]
    first, usual, position = what.places[0], Sigmas(), np.array([place.position for place in what.places])
    return _KINDS[what.kind].format(
        at=f"{_listed(first.position, '.2f')} m",
        turned=f"{_listed(np.degrees(first.angles), '.0f')} deg",
        loads=", ".join(f"{place.payload:g}" for place in what.places),
        count=len(what.places),
        apart=np.linalg.norm(position[:, None] - position, axis=-1).max(),
        tilt=np.degrees(TILT),
        modes=CABLE_MODES,
        length=1e3 * usual.length_m,
        position=1e3 * usual.position_m,
    )


def _listed(values: np.ndarray, digits: str) -> str:
    return f"({', '.join(format(value + 0.0, digits) for value in values)})"


def nats_text(nats: float) -> str:
    """A number of nats, as far as it says something."""
    return f"{nats:.0f} nats" if nats < MANY else f"more than {MANY:.0f} nats"


def recommendation_text(one: Recommendation) -> str:
    """What to measure, and which causes that is expected to separate."""
    cause, rival = (name.replace("_", " ") for name in one.separates)
    said = f"{measurement_text(one.what)}: expected to separate {cause} from {rival} by {nats_text(one.gain_nats)}"
    others = [pair for pair in one.pairs if (pair.cause, pair.rival) != one.separates]
    return said + "".join(
        f", {pair.cause} from {pair.rival} by {nats_text(pair.after - pair.before)}".replace("_", " ")
        for pair in others
    )
