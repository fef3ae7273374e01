"""Universal files and transient.csv in other programs: what they identify is what `modes` predicts."""

import importlib.util
import runpy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import pyuff

import cdpr_struct as cs
from cdpr_struct.cli.main import run

EXAMPLES = Path(__file__).parents[2] / "examples" / "modal_software"


@pytest.mark.parametrize(
    ("program", "package", "tolerance"),
    [("frf_in_sdypy_ema", "sdypy.EMA", 1e-6), ("transient_in_pyoma2", "pyoma2", 1e-6)],
)
def test_other_programs_identify_the_frequencies(program, package, tolerance):
    """Six modes of massless cables; measured relative errors below 4e-8 (sdyPy EMA), 2e-8 (pyOMA-2)."""
    pytest.importorskip(package.partition(".")[0], reason="the extra formats is not installed")
    if importlib.util.find_spec(package) is None:
        pytest.skip("the extra formats is not installed")
    predicted, found = runpy.run_path(str(EXAMPLES / f"{program}.py"))["identified"]()
    np.testing.assert_allclose(found, predicted, rtol=tolerance)


def test_shapes_are_written_with_the_cables(tmp_path):
    words = ["modes", "thesis-3-1", "--count", "8", "--uff", "--out", str(tmp_path), "--quiet"]
    assert run(words) == 0
    sets = pyuff.UFF(str(tmp_path / "modes.uff")).read_sets()
    assert [one["type"] for one in sets] == [15] + [82] * 8 + [55] * 8
    shapes, found = sets[9:], cs.modes("thesis-3-1", count=8)
    np.testing.assert_allclose([one["freq"] for one in shapes], found.modes.hertz, rtol=1e-5)  # six digits
    robot, nodes = cs.load_robot("thesis-3-1"), shapes[0]["node_nums"].astype(int).tolist()
    places = np.stack([sets[0][axis] for axis in "xyz"], axis=1)
    np.testing.assert_allclose(places[nodes.index(3000)], robot.frame_anchors[2], atol=1e-5)
    ends = [nodes.index(1000 * i + 999) for i in range(1, 9)]
    arms = places[ends] - places[nodes.index(1)]
    np.testing.assert_allclose(arms, robot.platform_anchors, atol=1e-4)
    for k, one in enumerate(shapes):
        motion = np.stack([one[f"r{axis}"] for axis in range(1, 7)], axis=1)
        np.testing.assert_allclose(motion[0], found.modes.platform[k], rtol=1e-4, atol=1e-6)
        carried = motion[0, :3] + np.cross(motion[0, 3:], arms)
        np.testing.assert_allclose(motion[ends, :3], carried, atol=2e-5)  # cables end on the platform
        assert np.abs(motion[[nodes.index(1000 * i) for i in range(1, 9)]]).max() == 0.0  # and begin at rest


def test_shapes_of_finite_elements_are_refused(tmp_path, capsys):
    words = ["modes", "thesis-3-1", "--model", "fem", "--elements", "4", "--count", "2", "--uff", "--out"]
    assert run([*words, str(tmp_path / "m"), "--quiet"]) == 2
    assert "--model: got 'fem'" in capsys.readouterr().err


def test_a_vibration_in_time_is_written(tmp_path):
    words = ["transient", "thesis-3-1", "--initial-velocity", "0.3,0,0.1", "--duration", "2", "--model", "static"]
    assert run([*words, "--uff", "--out", str(tmp_path), "--quiet"]) == 0
    sets = pyuff.UFF(str(tmp_path / "transient.uff")).read_sets()
    table = pd.read_csv(tmp_path / "transient.csv")
    assert [(one["rsp_node"], one["rsp_dir"], one["func_type"]) for one in sets] == [(1, d, 1) for d in range(1, 7)]
    np.testing.assert_allclose(sets[0]["data"], table["x_m_s2"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(sets[5]["data"], table["rz_rad_s2"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(sets[0]["x"], table["time_s"], rtol=1e-5)
