"""Measured damping ratios, per record, mode and amplitude, and what each law predicts for them."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.neighbours import crowded, pole_doubt
from cdpr_struct.measurement.signal_states import modal_amplitudes
from cdpr_struct.measurement.state_modes import StateModes

_BETTER = 0.5  # of the sigma of all windows together: a whole record so good speaks for itself, at its mean amplitude


@dataclass(frozen=True, slots=True, eq=False)
class DampingRows:
    """n measured damping ratios and their signatures.

    case, mode : (n,) name of the case, and number that is the same for all windows of one mode of one record
    hertz, ratio, sigma, amplitude : (n,) [Hz], [-], [-], largest displacement [m]
    entered    : (n,) ratio that the robot file's law gives: a medium at rest, `docs/damping.md`
    material   : (n,) per second of stiffness time b (Kelvin and Voigt): omega / 2 times the share of elastic energy
    structural : (n,) per loss factor: half of that share
    friction   : (n,) per N m of friction moment at both ends of each cable: 2 angle / (pi omega^2 amplitude)
    """

    case: tuple[str, ...]
    mode: np.ndarray
    hertz: np.ndarray
    ratio: np.ndarray
    sigma: np.ndarray
    amplitude: np.ndarray
    entered: np.ndarray
    material: np.ndarray
    structural: np.ndarray
    friction: np.ndarray

    def __len__(self) -> int:
        return len(self.ratio)


def damping_rows(identified: tuple[Identified, ...]) -> DampingRows:
    """Rows of all modes that join and have a partner; a decay gives one per window, an FRF one without amplitude (nan).

    Sigmas include what neighbouring modes may do that the signals do not distinguish. `left_out` names the modes that
    give no row.
    """
    case: list[str] = []
    table: list[tuple[float, ...]] = []
    for number, item in enumerate(identified):
        if item.state is None:
            continue
        laws = _laws(item.state)
        alone = np.array([not reason for reason in _reasons(item)], dtype=bool)
        for i in np.flatnonzero(item.used & alone):
            partner = int(item.partner[i])
            for ratio, sigma, modal in _readings(item, int(i), partner):
                own = [float(laws[j][partner]) for j in range(3)]
                shift = modal * float(np.linalg.norm(item.state.modes.platform[partner, :3]))
                label, hertz, rubbing = 100.0 * number + float(i), float(item.modes.hertz[i]), float(laws[3][partner])
                table.append((label, hertz, ratio, sigma, shift, *own, rubbing / modal))
                case.append(item.record.case)
    columns = np.array(table, dtype=float).reshape((-1, 9)).T
    return DampingRows(tuple(case), columns[0].astype(int), *columns[1:])


def left_out(identified: tuple[Identified, ...]) -> list[tuple[str, float, str]]:
    """Case, frequency [Hz] and reason of each mode that joined the campaign but says nothing of the damping."""
    return [
        (item.record.case, float(item.modes.hertz[i]), reason)
        for item in identified
        for i, reason in enumerate(_reasons(item))
        if item.used[i] and reason
    ]


def _reasons(item: Identified) -> list[str]:
    """(k,) why a mode gives no damping ratio, "" if it does."""
    single = crowded(item)
    return ["no partner in the model" if item.partner[i] < 0 else single[i] for i in range(len(item.modes))]


def _readings(item: Identified, i: int, partner: int) -> list[tuple[float, float, float]]:
    """(ratio, sigma, modal amplitude [sqrt(kg) m]) of mode i, window by window, or of the whole where it says more."""
    windows = item.windows
    hertz, ratio = float(item.modes.hertz[i]), float(item.modes.damping[i])
    whole = float(np.hypot(item.modes.damping_sigma[i], pole_doubt(item, _duration(item))[i] / hertz))
    if windows is None or not len(windows.middle):
        return [(ratio, whole, np.nan)]
    doubt = float(pole_doubt(item, float(windows.middle[1] - windows.middle[0]))[i]) / hertz
    clear = np.isfinite(windows.damping[:, i])
    if not clear.any():
        return []
    sigma, amplitude = windows.damping_sigma[clear, i], modal_amplitudes(item, i, partner)[clear]
    together = float(np.hypot(1.0 / np.sqrt((1.0 / sigma**2).sum()), doubt))
    if whole < _BETTER * together:
        return [(ratio, whole, float(np.exp(np.log(amplitude).mean())))]
    return list(
        zip(windows.damping[clear, i].tolist(), np.hypot(sigma, doubt).tolist(), amplitude.tolist(), strict=True)
    )


def _duration(item: Identified) -> float:
    """[s], infinite for an FRF."""
    axis = item.record.axis
    return np.inf if item.record.kind == "frf" else float(axis[-1] - axis[0])


def _laws(state: StateModes) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(k,) each: entered ratio, material, structural, and friction times modal amplitude, of the model's modes."""
    modes, omega = state.modes, state.modes.omega
    first = np.where(np.isfinite(state.first_frequency), state.first_frequency, 0.0)
    entered = (modes.cable_energy * state.point.entered.damping_ratio * first).sum(axis=1) / omega
    expansion = modes.expansion
    elastic = np.einsum("kma,mab,kmb->k", modes.end, expansion.static_stiffness, modes.end)
    elastic = (elastic + np.einsum("kmp,mp->k", modes.modal**2, expansion.omega_squared)) / omega**2
    return entered, 0.5 * elastic * omega, 0.5 * elastic, 2.0 * _angles(state) / (np.pi * omega**2)


def _angles(state: StateModes) -> np.ndarray:
    """(k,) sum over the cables of how far they turn at the frame and against the platform, per modal amplitude."""
    cables, motion = state.point.cables, state.modes.platform
    arms = state.point.entered.platform_anchors @ state.point.rotation.T
    ends = motion[:, None, :3] + np.cross(motion[:, None, 3:], arms[None])
    chord = np.linalg.norm(cables.offset, axis=-1)
    along = cables.offset / chord[:, None]
    swing = np.cross(along[None], ends) / chord[None, :, None]
    against = motion[:, None, 3:] - swing
    angles: np.ndarray = (np.linalg.norm(swing, axis=-1) + np.linalg.norm(against, axis=-1)).sum(axis=1)
    return angles
