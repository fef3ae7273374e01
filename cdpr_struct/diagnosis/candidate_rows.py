"""The candidates of a diagnosis as rows: what was mended, what was fitted, with sizes and evidence."""

from typing import Any

import numpy as np

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.refit import Fit, explained_share
from cdpr_struct.diagnosis.verdict import answers, classes_of, is_unknown
from cdpr_struct.diagnosis.whole_change import whole_change


def candidate_rows(found: Diagnosis) -> list[dict[str, Any]]:
    """What was mended in the data, in the order of its discovery, then every cause that was fitted, best first.

    A cause whose fitted size is none is left out, unless the verdict leaves it open: its evidence is that of other
    modes for the peaks, not its own. What was mended and does not suffice stands last.
    """
    mended: list[dict[str, Any]] = [
        {
            "cause": c.cause, "with": [], "parameters": c.sizes, "description": c.sentence, "log_evidence_gain": gain,
            "heldout_rms": None, "explained_fraction": _mended_share(found),
        }
        for c, gain in found.corrections
    ]  # fmt: skip
    best = found.selection.fit
    fits = {best.names: best} if best else {}
    for fit in [*filter(_is_change, found.selection.first), *_left_open(found)]:
        fits.setdefault(fit.names, fit)
    fitted = [row for fit in fits.values() for row in _fit_rows(found, fit)]
    return fitted + mended if is_unknown(found) else mended + fitted


def _left_open(found: Diagnosis) -> list[Fit]:
    """Fits of the chosen causes with one of them exchanged for a rival that these data do not tell apart from it."""
    classes = classes_of(found)
    return [rival for row in found.selection.rivals for rival in row if answers(rival.names, classes)]


def _is_change(fit: Fit) -> bool:
    """Whether sizes, all together, are a sigma or more from what was entered."""
    return float(fit.theta @ np.linalg.solve(fit.covariance, fit.theta)) > 1.0


def _mended_share(found: Diagnosis) -> float | None:
    """Share of the significant error that went with the only correction; of several each one's is not known."""
    if len(found.corrections) != 1:
        return None
    return explained_share(found.entered.white(found.entered.r), found.ground.z)


def _fit_rows(found: Diagnosis, fit: Fit) -> list[dict[str, Any]]:
    whole, covariance = whole_change(fit)
    sigmas = np.sqrt(np.diagonal(covariance))
    chosen = fit is found.selection.fit
    after = found.held.after / found.held.sigma if chosen and found.held is not None else None
    return [
        {
            "cause": choice.candidate.name, "with": [n for n in fit.names if n != choice.candidate.name],
            "pattern": choice.pattern.label,
            "parameters": {
                p.name: p.shown(float(t * prior), float(s * prior))
                for p, t, s, prior in zip(choice.pattern.parameters, theta, sigma, choice.prior, strict=True)
            },
            "log_evidence_gain": fit.gain, "explained_fraction": fit.explained(found.ground.z),
            "heldout_rms": None if after is None else float(np.sqrt(np.mean(after**2))),
        }
        for choice, theta, sigma in zip(fit.choices, fit.split(whole), fit.split(sigmas), strict=True)
    ]  # fmt: skip
