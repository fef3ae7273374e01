"""The browser window without a browser: a slider moves, picture and tables follow; words where viser is missing."""

import socket
import sys

import numpy as np
import pytest

from cdpr_struct.cli import view
from cdpr_struct.cli.main import run
from cdpr_struct.interface.view import open_window
from cdpr_struct.live.view_state import Refusal, ViewState

TABLE_4_4 = "examples/table-4-4/campaign.toml"


@pytest.fixture
def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def window(free_port):
    pytest.importorskip("viser")
    server, made = open_window("cogiro", campaign=TABLE_4_4, count=4, port=free_port)
    yield made
    server.stop()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_sliders_move_the_robot(window):
    window.step(0.0)
    first = window.shown.state
    assert "2.782" in window.mode_table.content
    window.pose[2].value = 2.0
    window.step(0.1)
    assert isinstance(window.shown.state, ViewState)
    assert window.shown.state.point.position[2] == 2.0
    assert (window.shown.state.lengths < first.lengths).all()
    np.testing.assert_allclose(window.platform.position, window.shown.state.point.position)
    assert f"{window.shown.state.tensions[0]:.1f}" in window.cable_table.content
    window.mode.value = 1
    window.step(0.375)  # a quarter of a swing
    moved = np.array(window.platform.position) - window.shown.state.point.position
    assert 0.01 < np.linalg.norm(moved) < window.amplitude.value
    window.pose[0].value = window.pose[0].max  # beyond what the cables hold
    window.step(0.5)
    assert isinstance(window.shown.state, Refusal)
    assert window.status.content.startswith("**Cannot be held.**")
    assert window.mode_table.content == window.cable_table.content == ""
    window.pose[0].value = 0.0
    window.given.value = "lengths"
    window.step(0.6)
    window.step(0.7)
    held = window.shown.state.lengths.copy()
    assert [slider.value for slider in window.lengths] == pytest.approx(held.tolist(), abs=1e-3)
    window.lengths[0].value = held[0] - 0.05
    window.step(0.8)
    assert isinstance(window.shown.state, ViewState)
    assert window.shown.state.lengths[0] == pytest.approx(held[0] - 0.05, abs=1e-9)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_measured_states_are_stepped_through(window):
    window.chosen.value = "horizontal centre"
    window.step(0.0)
    measured = window.shown.measured
    assert measured is not None
    np.testing.assert_allclose(window.shown.state.pose.in_degrees(), measured.controls.pose, atol=1e-12)
    assert f"{measured.tension[3]:.1f}" in window.residual_table.content
    window.chosen.value = "none"
    window.step(0.1)
    assert window.shown.measured is None


def test_without_the_extra_one_sentence_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "viser", None)
    assert run(["view", "thesis-3-1", "--no-browser"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "pip install 'cdpr-struct[view]'" in line


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["view", "thesis-9"], "ROBOT"),
        (["view", "thesis-3-1", "--pose", "1,2"], "--pose"),
        (["view", "thesis-3-1", "--payload", "-3"], "--payload"),
        (["view", "thesis-3-1", "--count", "0"], "--count"),
        (["view", "thesis-3-1", "--port", "70000"], "--port"),
        (["view", "thesis-3-1", "--campaign", "none.toml"], "none.toml"),
        (["view", "six-cable-4mm", "--campaign", TABLE_4_4], "it has 8 cables and six-cable-4mm has 6"),
    ],
)
def test_unusable_options_are_refused_in_one_line(words, said, monkeypatch, capsys):
    """Before a window is opened."""
    monkeypatch.setattr("cdpr_struct.interface.view.open_server", None)
    assert run([*words, "--no-browser"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_command_prints_the_address_and_ends_when_it_is_interrupted(free_port, monkeypatch, capsys):
    pytest.importorskip("viser")
    opened = []
    monkeypatch.setattr(view.webbrowser, "open", opened.append)
    monkeypatch.setattr("cdpr_struct.live.window.time.sleep", interrupt)
    assert run(["view", "thesis-5", "--port", str(free_port)]) == 0
    address = f"http://localhost:{free_port}"
    assert opened == [address]
    assert address in capsys.readouterr().out


def interrupt(seconds: float) -> None:
    raise KeyboardInterrupt
