"""Causes that campaigns often do not tell apart."""

_PAIRS = (
    "joint_compliance dead_length", "joint_compliance axial_stiffness", "dead_length axial_stiffness",
    "frame_compliance dead_length", "frame_anchor_position tracker_frame",
    "frame_anchor_position platform_anchor_position", "platform_anchor_position tracker_frame",
    "pulley_radius frame_anchor_position", "pulley_radius tracker_frame", "pulley_radius platform_anchor_position",
    "missing_pulleys frame_anchor_position", "missing_pulleys platform_anchor_position",
    "missing_pulleys tracker_frame", "backlash drum_scale", "backlash missing_pulleys",
    "axial_stiffness nonlinear_elasticity",
    "dead_length nonlinear_elasticity", "joint_compliance nonlinear_elasticity",
    "missing_pulleys unstrained_length_offset",
    "pulley_radius unstrained_length_offset", "unstrained_length_offset drum_scale", "external_force hose_stiffness",
    "gravity_tilt hose_stiffness", "gravity_tilt external_force", "load_cell_gain pulley_friction",
    "backlash unstrained_length_offset", "joint_mass platform_mass", "joint_mass hose_stiffness",
    "joint_mass external_force", "platform_mass hose_stiffness",
    "platform_mass external_force", "bending_stiffness cable_linear_density",
    "accelerometer_mass cable_linear_density", "temperature drum_scale", "flexible_platform steady_disturbance",
    "swinging_payload steady_disturbance",
    "swinging_payload flexible_platform", "swinging_payload platform_inertia", "swinging_payload platform_mass",
    "pose_mismatch sign_error", "viscous_damping hysteretic_damping",
)  # fmt: skip
CONFUSED = frozenset(frozenset(pair.split()) for pair in _PAIRS)
"""Pairs that campaigns often do not tell apart: what `plan` says of two examples, and what the blind tests met."""


def confused_with(name: str) -> list[str]:
    """Causes that campaigns often do not tell from this one."""
    return sorted(other for pair in CONFUSED if name in pair for other in pair - {name})
