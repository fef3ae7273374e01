"""Signals made of the referee's modes: each way of spoiling does what it says, and nothing else."""

import numpy as np
import pandas as pd
import pytest

from tests.blind.campaign_files import measurement_lines
from tests.blind.case_drawing import CaseKind
from tests.blind.measuring_plan import PlanSize
from tests.blind.sensors import POSE
from tests.blind.spoiled_signals import DECAY, FRF, GAIN, MOTION, SIGNALS, may_be_said
from tests.blind.spoilt_sets import RECORDED, SpoiltKind, group_realities, read_case, spoilt_kinds

SMALL = PlanSize(static_states=4, locks=1, loads_per_lock=2, frequency_states=2)
VALUES = {FRF: ["real", "imag"], DECAY: ["ax", "ay", "az"], MOTION: POSE}


@pytest.fixture(scope="module")
def real():
    reality = CaseKind("null", size=SMALL, statics=True, signals=True, robot="thesis-3-1")
    kind = SpoiltKind(0, reality, "clean", 0.0, FRF)
    return kind, group_realities([kind], (11, 5))[kind.reality]


def table(real, signal: str, way: str) -> pd.DataFrame:
    kind, reality = real
    case = read_case(SpoiltKind(0, kind.reality, way, 0.0, signal), reality, (5, 7))
    assert set(case.tables) == {"static_state", "loaded_pose", signal}
    assert "frequency_hz = 0.01" in measurement_lines(signal, case.tables[signal])[-1]
    return case.tables[signal]


@pytest.mark.parametrize("signal", [FRF, DECAY, MOTION])
def test_every_way_changes_the_signal_in_its_way(real, signal):
    clean = table(real, signal, "clean")
    values = VALUES[signal]
    for way in SIGNALS[1:]:
        spoilt = table(real, signal, way)
        if way == "dropped":
            assert 0.9 * len(clean) < len(spoilt) < len(clean)
        elif way == "blank":
            share = spoilt[values].isna().mean()
            assert ((share > 0.01) & (share < 0.05)).all()
        else:
            assert not np.allclose(spoilt[values], clean[values]), way


def test_peaks_of_a_response_are_modes_of_the_referee(real):
    _, reality = real
    one = table(real, FRF, "clean").query("case == 's01' and respond == 'z' and excite == 'fz'")
    size = np.hypot(one["real"], one["imag"]).to_numpy()
    peak = float(one["frequency_hz"].iloc[size.argmax()])
    assert np.abs(reality.seen.robot_hz[0] - peak).min() < 0.05


def test_a_wrong_gain_is_that_of_the_sensor_along_z(real):
    clean, spoilt = (table(real, DECAY, way) for way in ("clean", "gain"))
    ratio = (spoilt[["ax", "ay", "az"]] / clean[["ax", "ay", "az"]]).median()
    assert ratio.to_numpy() == pytest.approx([1.0, 1.0, GAIN[DECAY]])
    assert may_be_said(FRF, "gain")[-1] == "accelerometer_gain"
    assert "accelerometer_gain" not in may_be_said(DECAY, "gain")
    assert [way for way in SIGNALS if "pose_mismatch" in may_be_said(DECAY, way)] == ["exchanged"]


def test_a_third_hides_nothing_and_the_rest_two_and_four_times_the_detectable_size():
    for name, signal in RECORDED.items():
        kinds = spoilt_kinds(name, 90, 3)
        asked = [max((multiple for _, multiple in kind.reality.effects), default=0.0) for kind in kinds]
        assert {kind.signal for kind in kinds} == {signal}
        assert sorted(set(asked)) == [0.0, 2.0, 4.0]
        assert all(asked.count(size) == 30 for size in (0.0, 2.0, 4.0))
