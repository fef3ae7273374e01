"""result.json of a test plan: detectable sizes, confusions, next measurements."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.planning.campaign_plan import Plan
from cdpr_struct.planning.places import Place
from cdpr_struct.planning.separations import Gain
from cdpr_struct.reports.plan.measurements import measurement_text, nats_text

_HELPS = 0.1  # nats that a pair must gain to be listed


def plan_json(plan: Plan) -> dict[str, Any]:
    """result.json of `plan`."""
    return {
        "detectable": [{"cause": n, "minimum_detectable": v} for n, v in plan.detectable.items()],
        "confusable": [[p.cause, p.taken_for] for p in plan.confusable],
        "confusable_nats": [p.nats for p in plan.confusable],
        "next": [_next(gain) for gain in plan.gains],
        "not_testable": dict(plan.not_testable),
    }


def _next(gain: Gain) -> dict[str, Any]:
    first, text = gain.separations[0], measurement_text(gain.measurement)
    return {
        "measurement": text,
        "kind": gain.measurement.kind,
        "states": [_state(place) for place in gain.measurement.places],
        "gain_nats": gain.nats,
        "sentence": f"{text}: separates {first.cause} from {first.rival}, expected {nats_text(first.after)}",
        "separates": [
            {"cause": s.cause, "from": s.rival, "nats_before": s.before, "nats_after": s.after}
            for s in gain.separations
            if s.after > s.before + _HELPS
        ],
    }


def _state(place: Place) -> dict[str, Any]:
    return {"pose": [*place.position.tolist(), *np.degrees(place.angles).tolist()], "payload_kg": place.payload}


def detectable_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of detectable.csv, one row a cause."""
    sizes = result["detectable"]
    least = {key: [row["minimum_detectable"][key] for row in sizes] for key in ("value", "unit", "pattern")}
    return {"cause": [row["cause"] for row in sizes], **least}
