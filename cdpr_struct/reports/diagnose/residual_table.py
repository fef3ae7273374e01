"""The residuals of a diagnosis as a table."""

from collections import defaultdict
from collections.abc import Iterator
from itertools import count
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.reports.diagnose.result import KINDS


def residual_columns(found: Diagnosis) -> dict[str, Any]:
    """Residuals as entered and with the causes, one kind of row after another; rows are numbered within each kind."""
    rows, after = found.recorded, found.residuals
    counted: defaultdict[tuple[str, int], Iterator[int]] = defaultdict(lambda: count(1))
    factor = np.array([KINDS[kind][1] for kind in rows.kind])
    same = len(after.kind) == len(rows.kind)
    return {
        "block": rows.kind,
        "case": [found.campaign.states.names[i] for i in rows.state],
        "row": [next(counted[place]) for place in zip(rows.kind.tolist(), rows.state.tolist(), strict=True)],
        "cable": [cable + 1 if cable >= 0 else "" for cable in rows.cable.tolist()],
        "residual": factor * rows.before,
        "unit": [KINDS[kind][2] for kind in rows.kind],
        "sigma": factor * rows.sigma,
        "with_causes": factor * after.after if same else np.full(len(rows.kind), np.nan),
    }
