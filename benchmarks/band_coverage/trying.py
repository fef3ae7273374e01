"""One seed: a robot as predicted, and as it was really built."""

from typing import Any

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.band_coverage.drawing import Case, drawn
from benchmarks.band_coverage.fem_rest import FemRest, fem_rest
from benchmarks.band_coverage.prediction import Prediction, predicted
from benchmarks.band_coverage.true_robot import drawn_true_robot
from cdpr_struct.errors import CdprError

Told = dict[str, Any]


def tried(seed: int) -> Told:
    """What came of a seed: whether each truth lies in each band, and its probability."""
    case = drawn(seed)
    about = {"seed": seed, "kind": case.kind, "cables": len(case.robot.cables), "passed_over": case.passed_over}
    try:
        prediction = predicted(case)
    except CdprError as error:
        return about | {"refused": f"{type(error).__name__}: {error}"}
    about |= {"warned": prediction.warned, "margin": prediction.margin, "meeting": prediction.meeting}
    data = drawn_true_robot(case.rng, case.robot, np.asarray(case.held.answer["lengths_m"]))
    try:
        truth, change, elements = fem_rest(data, case.pose.position, case.pose.rotation, prediction.sigma)
    except fem.FemError as error:
        return about | {"lost": f"{type(error).__name__}: {error}"}
    return about | {"mesh_change": change, "elements": elements} | compared(case, prediction, truth)


def compared(case: Case, prediction: Prediction, truth: FemRest) -> Told:
    """Of pose, tensions and frequencies, in this order: distance in sigmas, and inside at each level; of the chosen
    frequency, component and tension, in this order: their places among these, and their probabilities."""
    distance = (truth.all - prediction.middle.all) / prediction.sigma.all
    inside = {
        str(level): ((ends[:, 0] <= truth.all) & (truth.all <= ends[:, 1])).tolist()
        for level, ends in prediction.bands.items()
    }
    m = len(case.robot.cables)
    return {
        "distance": distance.tolist(),
        "inside": inside,
        "chosen": [6 + m + case.frequency, case.component, 6 + case.cable],
        "probability": prediction.probability(truth, case.frequency, case.component, case.cable),
    }
