"""Modal damping: a ratio for each mode of the robot, in frequency and in time."""

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import ModalDamping, Undamped
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.frequency_sweep import modes_below, sweep_response
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.modal_response import modal_response
from cdpr_struct.dynamics.natural_frequencies import natural_frequencies
from cdpr_struct.dynamics.ports import CablePort, PlatformPort, platform_port
from cdpr_struct.dynamics.transient import after_stop, complex_modes
from tests.conftest import at_rest

AXES = np.eye(3)
PORTS = (
    platform_port("z", AXES[2], False, np.array([0.3, -0.2, 0.1])),
    platform_port("x", AXES[0], False, np.zeros(3)),
    platform_port("ry", AXES[1], True, np.zeros(3)),
    CablePort("cable5@0.3:z", 4, 0.3, AXES[2]),
)
TOP = 8.0


@pytest.fixture(scope="module")
def point():
    return at_rest("cogiro", np.array([1.0, 0.5, 1.5]))


def test_ratios_are_those_of_the_modes_and_the_last_one_stays():
    assert ModalDamping((0.01, 0.02)).of_modes(4).tolist() == [0.01, 0.02, 0.02, 0.02]
    assert ModalDamping((0.01, 0.02)).of_modes(1).tolist() == [0.01]
    for wrong in ((), (1.0,), (-0.1,), (float("nan"),)):
        with pytest.raises(ValueError, match="in \\[0, 1\\)"):
            ModalDamping(wrong)


@pytest.mark.parametrize(("model", "error"), [("static", 1e-11), ("dsm", 2e-4), ("exact", 1e-6)])
@pytest.mark.parametrize("excite", [PORTS[0], PORTS[3]], ids=lambda port: port.name)
def test_without_ratios_it_is_the_undamped_response(point, model, error, excite):
    """Residual flexibility included, 0.02 Hz and more from the modes; the closed form's series is a truncated one."""
    if model == "static" and excite is PORTS[3]:
        pytest.skip("massless cables cannot be shaken")
    highest = 2.0 * np.pi * TOP * (4.0 if excite is PORTS[3] else 1.0)
    cables = cable_dynamics(point, model, 2.0 * highest)
    modes = modes_below(point, cables, TOP)
    hertz = np.arange(0.3, TOP, 0.007)
    hertz = hertz[np.abs(hertz[:, None] - modes.hertz).min(axis=1) > 0.02]
    direct = frequency_response(point, cables, Undamped(), excite, PORTS, hertz, "displacement").response
    none = ModalDamping((0.0,))
    found = modal_response(point, cables, none, excite, PORTS, highest, modes.hertz, "displacement").at(hertz)
    size = np.abs(direct).max(axis=0)
    assert (np.abs(found - direct).max(axis=0) < error * size)[:3].all()
    # a point of a shaken cable: 1 / number of modes on both sides, which differ
    assert np.abs(found - direct)[:, 3].max() < (error if excite is PORTS[0] else 0.02) * size[3]


@pytest.mark.parametrize("ratio", [1e-2, 1e-4])
@pytest.mark.parametrize("mode", [0, 3, 5])
def test_peak_is_the_closed_form_of_one_mode(point, mode, ratio):
    """A force that shakes one of the six modes on massless cables alone, M phi_n: with zeta its ratio, the accelerance
    peaks at f / sqrt(1 - 2 zeta^2) with the height 1 / (2 zeta sqrt(1 - zeta^2)), at unit modal mass.
    """
    modes = modal_basis(point, cable_dynamics(point, "static"), Undamped(), 6, 1e3).modes
    port = PlatformPort("mode", modes.platform_mass @ modes.platform[mode])
    ratios = ModalDamping((0.3,) * mode + (ratio, 0.3))
    found = sweep_response(point, "static", ratios, port, (port,), np.arange(1.0, 40.0, 0.1)).peaks[0]
    assert len(found.hertz) == 1
    hertz = modes.omega[mode] / (2.0 * np.pi)
    assert found.hertz[0] == pytest.approx(hertz / np.sqrt(1.0 - 2.0 * ratio**2), rel=1e-3 * ratio)
    assert found.magnitude[0] == pytest.approx(1.0 / (2.0 * ratio * np.sqrt(1.0 - ratio**2)), rel=1e-5)
    assert found.damping_ratio[0] == pytest.approx(ratio, rel=1e-4 + 10.0 * ratio**2)


def test_peak_heights_and_widths_follow_the_ratios(point):
    """Twice the ratio of all modes: half the height and twice the width of well separated peaks."""
    hertz = np.arange(2.0, TOP, 0.05)
    one, two = (sweep_response(point, "exact", ModalDamping((z,)), PORTS[0], PORTS[:1], hertz) for z in (1e-4, 2e-4))
    highest = int(one.peaks[0].magnitude.argmax())
    same = int(np.abs(two.peaks[0].hertz - one.peaks[0].hertz[highest]).argmin())
    assert two.peaks[0].magnitude[same] == pytest.approx(0.5 * one.peaks[0].magnitude[highest], rel=2e-3)
    assert one.peaks[0].damping_ratio[highest] == pytest.approx(1e-4, rel=5e-3)
    assert two.peaks[0].damping_ratio[same] == pytest.approx(2e-4, rel=5e-3)
    assert one.ratios == pytest.approx(np.full(len(one.ratios), 1e-4))


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
def test_peaks_are_at_certified_frequencies(model):
    """To a half-power width, here 2e-6 of the frequency; those of the closed form's modal series lie up to 4e-6 off."""
    point = at_rest("thesis-3-1", np.array([1.3, -0.8, 0.9]))
    found = sweep_response(point, model, ModalDamping((1e-6,)), PORTS[0], PORTS[:1], np.arange(2.0, TOP, 0.05))
    apart = np.abs(found.peaks[0].hertz[:, None] - found.modes.hertz).min(axis=1)
    assert len(apart) > 2
    assert (apart < 1e-6 * found.peaks[0].hertz).all()


def test_a_mode_without_a_ratio_is_a_pole(point):
    """Mode 3 alone undamped."""
    ratios = ModalDamping((0.01, 0.01, 0.0, 0.01))
    found = sweep_response(point, "exact", ratios, PORTS[0], PORTS[:1], np.arange(0.3, TOP, 0.05))
    unbounded = np.isinf(found.peaks[0].magnitude)
    assert found.peaks[0].hertz[unbounded].tolist() == [found.modes.hertz[2]]
    assert (~unbounded).sum() > 2


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
def test_modes_decay_with_their_ratios(point, model):
    count = 6 if model == "static" else 20
    cables = cable_dynamics(point, model, 2.0 * np.pi * TOP)
    ratios = ModalDamping((0.01, 0.02, 0.005))
    basis = modal_basis(point, cables, ratios, count, 2.0 * np.pi * TOP)
    modes = complex_modes(basis)
    expected = ratios.of_modes(count)
    np.testing.assert_allclose(np.sort(modes.damping_ratio), np.sort(expected), rtol=1e-9)
    certified = natural_frequencies(point, cables, count).hertz
    np.testing.assert_allclose(modes.damped_hertz, certified * np.sqrt(1.0 - expected**2), rtol=3e-4)


def test_energy_never_grows(point):
    cables = cable_dynamics(point, "exact", 2.0 * np.pi * TOP)
    basis = modal_basis(point, cables, ModalDamping((0.02,)), 20, 2.0 * np.pi * TOP)
    energy = after_stop(basis, np.array([0.3, -0.2, 0.1, 0.0, 0.1, 0.0]), PORTS, np.arange(0.0, 3.0, 0.005)).energy
    assert (np.diff(energy) <= 1e-12 * energy[0]).all()
    assert energy[-1] < 0.5 * energy[0]
