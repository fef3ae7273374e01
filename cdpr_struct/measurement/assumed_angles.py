"""Files that give a position without all its angles: the others are taken as zero, and that is said."""

from collections.abc import Sequence

ANGLES = ("rx_deg", "ry_deg", "rz_deg")
_POSITION = "x_m"


def angle_note(file: str, names: Sequence[str]) -> str:
    """Sentence on the angles that a file with these columns lacks; "" if it gives all, or no pose at all."""
    lacking = [name for name in ANGLES if name not in names]
    if not lacking or _POSITION not in names:
        return ""
    if len(lacking) == len(ANGLES):
        return f"{file} has no columns {', '.join(lacking)}: the platform is taken as level there, all angles zero."
    if len(lacking) == 1:
        return f"{file} has no column {lacking[0]}: this angle is taken as zero there."
    return f"{file} has no columns {', '.join(lacking)}: these angles are taken as zero there."
