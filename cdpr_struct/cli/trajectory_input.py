"""The trajectory that an option names: `interface.trajectory`, under the name that commands use."""

from cdpr_struct.interface.trajectory import FORMS, read_trajectory

__all__ = ["FORMS", "read_trajectory"]
