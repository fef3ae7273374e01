"""What every map that holds poses says of the state of rest at each."""

import numpy as np

from cdpr_struct.statics.inverse_kinematics import InverseSolution, InverseStatus
from cdpr_struct.statics.slack_cables import sag_over_chord, slack_count
from cdpr_struct.statics.strained_cables import strains
from cdpr_struct.workspace.work_list import Columns


def rest_columns(solution: InverseSolution) -> Columns:
    """Of poses (n,) how many cables hang slack, the largest sag over chord and the largest strain (nan where a pose is
    not held), `cut_short`: the search for tensions ended before it had converged, and `held`."""
    with np.errstate(invalid="ignore"):
        sag = np.nan_to_num(sag_over_chord(solution.cables), nan=0.0).max(axis=-1)
        strain = strains(solution.cables).max(axis=-1)
    return {
        "slack_cables": slack_count(solution.cables, solution.held),
        "sag_over_chord_max": np.where(solution.held, sag, np.nan),
        "strain_max": np.where(solution.held, strain, np.nan),
        "cut_short": solution.status == InverseStatus.NOT_CONVERGED,
        "held": solution.held,
    }
