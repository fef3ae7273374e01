"""What the pages of the causes say beyond the library's own fields: law, sign, appearance, look-alikes, reference."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Description:
    """Half sentences of one cause.

    law : what it does, as a formula;  sign : what a value above its neutral one means, "" without one
    looks : what a reader sees in the data;  reference : where the law comes from, "" where it needs no source
    """

    law: str
    sign: str
    looks: str
    reference: str = ""


_HOOKE = "Hooke's law of the elastic catenary: [formulas](../formulas/catenary.md)"
_MASSES = "Mass matrix of the platform: [formulas](../formulas/platform.md), thesis eq. (3.12)"
_DAMPING = "[Damping laws](../damping.md)"
_ALL_LENGTHS = "Lengths of all cables are off in the same sense, most where {more}. The wrenches balance"

DESCRIPTIONS = {
    "axial_stiffness": Description(
        "EA of the cable becomes EA times the factor",
        "above 1: stiffer than entered",
        _ALL_LENGTHS.format(more="tension times free length is largest")
        + ". Platform frequencies move together, by up to half of the change of EA; cable frequencies follow the "
        "tensions",
        _HOOKE,
    ),
    "joint_compliance": Description(
        "the frame end of the cable gives way along the cable by compliance times tension",
        "never negative: the cable is softer than entered",
        _ALL_LENGTHS.format(more="the tension is largest, whatever the free length") + ". Platform frequencies fall",
        "Springs in series: [dynamics](../dynamics.md#extensions)",
    ),
    "dead_length": Description(
        "the frame end of the cable gives way along the cable by dead length / EA times tension",
        "never negative: the cable is softer than entered",
        _ALL_LENGTHS.format(more="the tension is largest, whatever the free length")
        + ". To the model it is a compliance in series: it differs from joint_compliance only in what one checks",
        "Springs in series: [dynamics](../dynamics.md#extensions)",
    ),
    "frame_compliance": Description(
        "the exits of a mast move by compliance times the sum of its cables' forces on it; bending sideways, as an "
        "upright clamped at its foot",
        "never negative: the frame is softer than entered",
        "Lengths are off where the cables of a mast pull in the same direction. A cable's error depends on the "
        "tension of "
        "its neighbours at the same mast. Platform frequencies fall",
        "Euler-Bernoulli beam for masts that bend: [dynamics](../dynamics.md#extensions)",
    ),
    "nonlinear_elasticity": Description(
        "EA becomes EA (1 + k (T / T0 - 1)), or level EA (T / T0)^exponent: this is the secant, tension over "
        "strain, and small motion has the same. Or the law is elastic, and small motion has its slope: then level "
        "EA (T / T0)^n with n = exponent_elastic is the tangent, dT over d strain, and the secant is (1 - n) times "
        "that. T is the tension at the platform, T0 the mean tension of the campaign",
        "k and exponents above 0: stiffer at high tension; level above 1: stiffer than entered at T0",
        "Lengths of tight and of slack cables are off in opposite senses; at one preload it looks like another EA. "
        "Static readings do not tell the last two laws apart: frequencies of the robot do, which in an elastic law "
        "are too high for the stretch under load",
        "Feyrer, *Wire Ropes*, 2nd edition, 2015, chapter 2: the modulus of a rope depends on its stress; the "
        "power is the simplest law without a stress at which the modulus would vanish",
    ),
    "creep": Description(
        "EA becomes EA / (1 + creep log10(1 + t / 1 min))",
        "never negative: cables grow longer under load",
        "Length errors that grow with the logarithm of time, in proportion to tension times free length",
    ),
    "frame_anchor_position": Description(
        "the frame anchor of the cable moves by the vector",
        "true minus entered, world axes",
        "Lengths of that cable are off by the part of the vector along the cable, so the error changes sign "
        "between poses. "
        "The wrench balance hardly changes: the direction of a long cable turns little",
    ),
    "platform_anchor_position": Description(
        "the platform anchor of the cable moves by the vector",
        "true minus entered, platform axes",
        "Lengths of that cable are off, and the moments do not balance: its lever arm is another",
    ),
    "unstrained_length_offset": Description(
        "length paid out = encoder length + offset",
        "above 0: more cable is out than the encoder says",
        "Length of that cable is off by the same amount at every pose. In a preloaded robot all tensions change",
    ),
    "drum_scale": Description(
        "length paid out = encoder length times the factor",
        "above 1: more cable is out than the encoder says",
        "Lengths are off in proportion to the length of the cable",
    ),
    "temperature": Description(
        "cables and frame expand by 1.2e-5 per kelvin (steel)",
        "above 0: warmer than at calibration",
        "Lengths are off in proportion to length and, in the other sense, to the distance of the frame anchors "
        "from the "
        "origin; the two nearly cancel where cables and frame are of one metal",
    ),
    "pulley_radius": Description(
        "the radius of the pulley becomes radius + change; the cable wraps more or less of it",
        "above 0: larger than entered",
        "Lengths are off by amounts that depend on the wrap angle, so they change with height and distance",
    ),
    "missing_pulleys": Description(
        "every cable that has no pulley in the robot file runs over one. It arrives along the swivel axis at the frame "
        "anchor, bends over the wheel and leaves it at a tangent. The axis points the way the cable runs: up, down, "
        "along a horizontal axis of the world, outwards (away from the middle of the frame anchors), inwards, or to "
        "the left or right of outwards. It may lean from these directions by two angles; each is reported as "
        "radius times angle. If the winches were homed without pulleys in the model, each cable has a zero "
        "offset in addition",
        "never negative",
        "Lengths are off by the radius times (wrap angle minus its sine), so the error depends on the direction of the "
        "cable. Directions and lever arms change by the radius over the cable's length",
        "Geometry of the swivelling pulley: [how to enter pulleys](../pulleys.md)",
    ),
    "tracker_frame": Description(
        "true pose = pose read, turned and shifted by the parameters",
        "what turns the tracker's frame into the robot's",
        "Lengths of all cables are off as if the platform stood elsewhere, by the same vector at every pose. With a "
        "rotation the wrench balance is off as well. Tensions and frequencies do not change",
    ),
    "gravity_tilt": Description(
        "the weight acts along (tilt_x, tilt_y, -1)",
        "above 0: the weight has a part along +x or +y",
        "A horizontal force is missing from the balance, the same at every pose and in proportion to mass plus payload",
    ),
    "pose_mismatch": Description(
        "true pose of one state = pose read, turned and shifted by the parameters",
        "what turns the entered pose into the true one",
        "Everything is off in one state and nothing in the others. Where two records of vibration are filed under "
        "each other's case, frequencies and modal constants of these two states are those of the other pose",
    ),
    "platform_mass": Description(
        "mass becomes mass times the factor; the inertia stays",
        "above 1: heavier than entered",
        "A vertical force is missing from the balance, the same at every pose and payload. Frequencies of the "
        "translations move by half of the change, the other way",
        _MASSES,
    ),
    "joint_mass": Description(
        "a point mass sits at the platform anchor of the cable",
        "never negative: the platform is heavier than entered",
        "As platform_mass, and the frequencies of the rotations fall more than those of the translations: the "
        "masses sit "
        "far from the centre",
        _MASSES,
    ),
    "center_of_mass": Description(
        "the centre of mass moves by the vector",
        "true minus entered, platform axes",
        "Horizontal moments are missing from the balance: mass times gravity times the lever arm. The height of "
        "the centre "
        "shows at tilted poses only",
        _MASSES,
    ),
    "platform_inertia": Description(
        "moments and products of inertia about an axis become larger by the factor (products by its root)",
        "above 1: larger than entered",
        "Frequencies of the rotations alone move, by half of the change, the other way. Nothing static changes",
        _MASSES,
    ),
    "external_force": Description(
        "a force acts on the platform origin",
        "force on the platform, world axes",
        "A force is missing from the balance, the same at every pose and payload",
    ),
    "hose_stiffness": Description(
        "a force on the platform origin: constant part minus stiffness times distance from the campaign's mean "
        "position",
        "never negative: the hose pulls back",
        "A force is missing from the balance that grows with the distance from the mean position",
    ),
    "flexible_platform": Description(
        "a part of the platform's mass moves along one axis on a spring, with this frequency when the platform is held",
        "mass and frequency are positive",
        "One peak more than the model has, and the modes on both sides of it are pushed apart. Nothing static changes",
        "Den Hartog, *Mechanical Vibrations*, 4th edition, 1956, dynamic vibration absorber",
    ),
    "swinging_payload": Description(
        "a part of the platform's mass hangs from a point of it and swings in both directions across gravity, with "
        "this frequency when the platform is held: a pendulum of length l has sqrt(g / l) / (2 pi). At a frequency "
        "f the platform feels m f_p^2 / (f_p^2 - f^2) across gravity and m along it. At rest the weight pulls at "
        "the hook, whatever the tilt, and so the platform's mass, centre and inertia count it as a point there",
        "mass and frequency are positive; the hook is a place of the platform's frame",
        "Two slow peaks more than the model has, if one looked so low. Above them horizontal modes, and rotations "
        "that move the hook, are as of a lighter platform: they rise together, vertical ones stay. Nothing static "
        "changes",
        "Lamb, *Hydrodynamics*, 6th edition, 1932, art. 191, and Abramson, NASA SP-106, 1966, for liquids: each "
        "slosh mode is such a pendulum",
    ),
    "steady_disturbance": Description(
        "a line at this frequency is in the list of peaks and belongs to no mode",
        "a frequency is positive",
        "One peak more, at the same frequency at every pose and payload",
    ),
    "cable_linear_density": Description(
        "mass per length of the cable becomes larger by the factor",
        "above 1: heavier than entered",
        "Cable frequencies move by half of the change, the other way, in all modes alike. The rest is small unless the "
        "cables are heavy",
        "Taut string, and [the closed form](../formulas/cable_dsm.md)",
    ),
    "bending_stiffness": Description(
        "the cable resists bending with the stiffness EI. Its ends are clamped in direction (bending_stiffness), "
        "pinned (bending_stiffness_pinned), or something between. Then both sizes are fitted: their sum is EI, and "
        "bending_stiffness over this sum is the fixity of the ends (0 pinned, 1 clamped)",
        "never negative: frequencies rise",
        "Cable frequencies rise, the higher modes more. Short and loose cables show it most",
        "Fletcher and Rossing, *The Physics of Musical Instruments*, 2nd edition, 1998, stiff string",
    ),
    "cable_added_mass": Description(
        "a point mass sits on the cable. The search starts at 0.1, 0.22, 0.35 and 0.5 of the cable's length from the "
        "platform (added_mass alone is 0.5), and the distance from there is fitted (added_mass_beyond). The mirrored "
        "place in the other half of the cable fits nearly as well",
        "never negative: frequencies fall",
        "The frequencies of that cable fall, most for modes that move far where the mass sits. A mode with a node "
        "there keeps its frequency",
    ),
    "load_cell_gain": Description(
        "load cell reading = gain times tension",
        "above 1: the cell reads too much",
        "The readings do not balance the weight, in proportion to it; cable frequencies contradict the readings of "
        "tension. The robot itself, its pose and frequencies, does not change",
    ),
    "load_cell_bias": Description(
        "load cell reading = tension + bias",
        "above 0: the cell reads too much",
        "The balance is off by the same force along that cable at every tension",
    ),
    "pulley_friction": Description(
        "load cell reading = tension times exp(s (friction times right angles of wrap + 2 asinh(b sin(wrap / 2) / "
        "sqrt(1 - b^2)))) + s drag, s the sign of the last motion. The first part is a cable that slips on its "
        "wheel. The second is a wheel that turns, whose bearing of radius r and friction mu carries the resultant "
        "F of both tensions: (T1 - T2) R = mu r F, and bearing_friction b is mu r / R. The drag of seals and of a "
        "swivel is constant",
        "s is +1 if the winch last wound in: the cell, on the winch side, reads more",
        "As load_cell_gain, but the error changes sign with the direction from which the pose was reached. The "
        "slip of a cable doubles from a right angle of wrap to a half turn, bearing friction grows by 1.4, the "
        "drag stays",
        "Capstan equation (Euler and Eytelwein); friction of a journal bearing: Budynas and Nisbett, *Shigley's "
        "Mechanical Engineering Design*, 10th edition, 2015, chapter 12",
    ),
    "backlash": Description(
        "length paid out = encoder length + s backlash / 2, s the sign of the last motion: the drum lags behind "
        "the motor by half of the play on either side. States are taken to lie beyond the play, the motor having "
        "turned by more than it since it last reversed",
        "s is +1 if the winch last wound in: more cable is out than the encoder says",
        "Lengths of a cable are off by the same amount at every pose, with a sign that changes with the direction "
        "from which the pose was reached. The wrenches balance",
        "Nordin and Gutman, Controlling mechanical systems with backlash, *Automatica* 38, 2002: dead zone of a gear",
    ),
    "brake_slip": Description(
        "length paid out = encoder length + rate times time",
        "above 0: cable is paid out",
        "Length error of one cable that grows evenly with time",
    ),
    "sensor_delay": Description(
        "at the time of the pose, length and tension are the readings less delay times their rates. Rates of lengths "
        "come from a spline through the frames of a motion, those of tensions from a smoothing spline. Where lengths "
        "and tensions were read, poses may be late against both (delay), against lengths alone (delay_of_lengths) or "
        "against tensions alone (delay_of_tensions)",
        "above 0: the poses are older than what is filed with them. The extended robot holds how much older lengths "
        "(encoder_delay) and tensions (cell_delay) are than poses, of the other sign",
        "Length errors in proportion to the speed of each cable, with the other sign on the way back; none at rest. "
        "Tensions that are late do not balance weight and inertia, in proportion to their rates",
    ),
    "clock_drift": Description(
        "the delay of the poses grows by drift times the time since the first reading. Beside a delay at the start "
        "both are found, sensor_delay and clock_drift",
        "above 0: the clock of the poses is fast, so that they grow older than what is filed with them",
        "As of a delay that is nothing at the start and grows evenly: the same motion shows larger errors each time",
        "Mills, *Computer Network Time Synchronization*, 2nd edition, 2011: clocks differ by an offset and a rate",
    ),
    "accelerometer_gain": Description(
        "the FRF is multiplied by the gain",
        "above 1: the sensor reads too much",
        "All FRFs of a direction are too high by one factor; no frequency and no damping ratio changes",
        "Ewins, *Modal Testing*, 2nd edition, 2000",
    ),
    "accelerometer_mass": Description(
        "a point mass at the platform origin, while vibration is measured and only then",
        "never negative: frequencies of translations fall",
        "Frequencies are as for a heavier platform although tensions are not; cable frequencies rise with the weight "
        "that hangs on them",
        "Ewins, *Modal Testing*, 2nd edition, 2000",
    ),
    "internal_force": Description(
        "tensions change by a vector of the null space of the structure matrix",
        "tension read minus tension commanded",
        "Tensions differ from the commanded ones although they balance the same wrench at the same pose; cable "
        "frequencies "
        "follow the tensions",
        "Pott, *Cable-Driven Parallel Robots: Theory and Application*, 2018",
    ),
    "unit_error": Description(
        "the column is multiplied by a factor between units: mm, kN, kgf, degrees, rad/s and others",
        "",
        "All readings of a column are off by one factor far from 1",
    ),
    "sign_error": Description(
        "the column is multiplied by -1",
        "",
        "The error of the column is twice the reading: none where it is zero. Lengths and balance are off by far "
        "more than "
        "any tolerance",
    ),
    "rotation_convention": Description(
        "the same numbers mean another pose: angles about fixed axes in another order, the angle about z in the column "
        "of x, rotation vectors, the transposed rotation, quaternions with the real part at the other end, a frame "
        "whose y points up or z down, or a left-handed frame",
        "",
        "Lengths and balance are off where the platform is tilted about two axes or more, by the product of the angles "
        "for another order, and not at all where it is level",
    ),
    "swapped_channels": Description(
        "readings of two cables change places",
        "",
        "Two tensions (or lengths) are off by equal and opposite amounts at every pose",
    ),
    "cable_sag": Description(
        "straight cables without weight take the place of catenaries",
        "",
        "The weight of the cables is missing from the balance, and heavy, slack cables seem too short",
        "Irvine, *Cable Structures*, 1981; thesis section 2.2",
    ),
    "cable_dynamics": Description(
        "cables without mass take the place of vibrating ones",
        "",
        "Platform frequencies near those of the cables are off in both directions, and the cables' own peaks "
        "belong to no "
        "mode",
        "Thesis section 2.3",
    ),
    "attachment_geometric_stiffness": Description(
        "the stiffness loses the work of the static cable forces on the turning lever arms",
        "",
        "Frequencies of rotations are off, the more the higher the preload. Statics does not change",
        "[Models](../dynamics.md#the-thesis-assembly), thesis eq. (3.8)",
    ),
    "viscous_damping": Description(
        "damping rate proportional to mass (medium) or to stiffness (material)",
        "a factor above 1: more damping than entered",
        "Peaks are lower and broader, decays are shorter; in the material, high modes most. Frequencies do not change",
        _DAMPING,
    ),
    "hysteretic_damping": Description(
        "stiffness of the cables becomes K (1 + i times loss factor)",
        "a loss factor is positive",
        "Damping ratios of all stretch modes are alike, at half of the loss factor. Frequencies do not change",
        _DAMPING,
    ),
    "coulomb_damping": Description(
        "a constant moment opposes the rotation of the cable at both ends",
        "a moment is positive",
        "The damping ratio grows as the amplitude falls: the envelope of a decay is a straight line that ends. "
        "An FRF of one "
        "amplitude does not show it, so there is no picture",
        _DAMPING,
    ),
}
"""By name, all that a verdict can name."""
