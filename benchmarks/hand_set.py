"""The hand-set constants of the diagnosis, what each means, where it comes from, and how one is changed for a run."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from cdpr_struct.hypotheses.detectable import noncentrality
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.hypotheses.laws import laws
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded

STUDY = "a study of simulated campaigns"
CONVENTION = "convention"
CHOICE = "choice"
Follower = tuple[str, str, Callable[[Any], Any]]


def times(value: Any, factor: float) -> Any:
    """A number or a tuple of numbers, scaled; whole numbers stay whole."""
    if isinstance(value, tuple):
        return tuple(factor * one for one in value)
    return round(factor * value) if isinstance(value, int) else factor * value


def _beyond_one(value: np.ndarray, factor: float) -> np.ndarray:
    return 1.0 + factor * (value - 1.0)


def _of_outliers(value: np.ndarray, factor: float) -> np.ndarray:
    return np.concatenate([value[:1], factor * value[1:]])


def _odds(value: float, factor: float) -> float:
    odds = factor * value / (1.0 - value)
    return odds / (1.0 + odds)


def _commanded(campaign: Campaign) -> Any:
    return recorded(campaign).sent.known.tolist()


def _corrected(campaign: Campaign) -> Any:
    return [one.sentence for one in corrections(campaign)]


def _laws(campaign: Campaign) -> Any:
    data = recorded(campaign)
    return [(law.words, law.columns.static.shape) for law in laws(Local.about(data, Point.entered(data)))]


@dataclass(frozen=True, slots=True)
class Constant:
    """A hand-set constant.

    room, file, name : where it stands;  words : what it is;  origin : where its value comes from
    tried   : what shows its influence: "verdicts", "damping", "frf", "plans", or "" for nothing at hand
    beside  : whether it is used only after the search for causes, p-value of the null model included
    acts_by : the part of a campaign through which it acts: where a change leaves that as it is, so it does the verdict
    scaled  : value and factor to the value tried;  follows : constants that are computed from it, and how
    """

    room: str
    file: str
    name: str
    words: str
    origin: str
    tried: str = "verdicts"
    beside: bool = False
    acts_by: Callable[[Campaign], Any] | None = None
    scaled: Callable[[Any, float], Any] = times
    follows: tuple[Follower, ...] = ()

    @property
    def module(self) -> str:
        """Dotted."""
        return f"cdpr_struct.{self.room}.{self.file}"

    @property
    def key(self) -> str:
        """What tells it from others."""
        return f"{self.file}.{self.name}"

    @property
    def value(self) -> Any:
        """As it stands."""
        return getattr(import_module(self.module), self.name)


_PEAKS, _PLACES = "cdpr_struct.association.peak_noise", "cdpr_struct.planning.places"
HAND_SET: Sequence[Constant] = (
    Constant("inference", "scale_mixture", "KAPPA", "factors on a stated sigma that errors of readings and peaks may "
             "have", STUDY, scaled=_beyond_one, follows=((_PEAKS, "SCALES", lambda kappa: kappa[:-1]),)),
    Constant("inference", "scale_mixture", "PSEUDO_COUNTS", "prior counts of these factors: 4 % outliers, worth 30 "
             "readings", STUDY, scaled=_of_outliers, follows=((_PEAKS, "PSEUDO_COUNTS", lambda count: count[:-1]),)),
    Constant("inference", "scale_mixture", "TAU_DEGREES", "readings that the stated sigmas of a kind are worth", STUDY),
    Constant("inference", "scale_mixture", "OUTLIER", "factor from which a reading is called an outlier", CHOICE,
             beside=True),
    Constant("residuals", "assembled", "FLOOR", "model error of balance [N], lengths [m], ln frequency and ln modal "
             "constant", "measured against the FEM"),
    Constant("residuals", "commanded_lengths", "_TAUT", "tension over weight from which a commanded length tells of "
             "tension", CHOICE, acts_by=_commanded),
    Constant("residuals", "modal_sizes", "_LEAST", "share of a mode's largest modal constant below which a channel is "
             "left out", CHOICE, tried="frf"),
    Constant("residuals", "modal_sizes", "_APART", "distance of two modes, in sums of their damping ratios, below "
             "which both are left out", CONVENTION, tried="frf"),
    Constant("hypotheses", "hypothesis", "SCALES", "sizes of a cause in sigmas of its prior, equally likely", STUDY,
             follows=(("cdpr_struct.planning.separations", "WIDE", lambda s: float(np.exp(np.log(s).mean()))),)),
    Constant("hypotheses", "hypothesis", "PRICE", "prior log odds against a cause [nat]: one in twenty", STUDY),
    Constant("hypotheses", "detectable", "FALSE_ALARMS", "p-value below which a single test speaks", CONVENTION,
             beside=True),
    Constant("hypotheses", "detectable", "POWER", "probability of finding a change of the smallest detectable size; "
             "its odds are scaled", CONVENTION, scaled=_odds, beside=True),
    Constant("hypotheses", "detectable", "NAMED", "log Bayes factor from which a damping law is named, and up to which "
             "a plan counts evidence [nat]", CHOICE, tried="damping"),
    Constant("hypotheses", "significant", "SIGNIFICANT", "p-value of the null model below which something is wrong",
             "nulls of simulated campaigns", beside=True),
    Constant("hypotheses", "significant", "_OUTSIDE", "log weight of all laws outside the library, against one cause, "
             "in that p-value [nat]", CHOICE, beside=True),
    Constant("hypotheses", "correction", "_TILTED", "share of the largest angle above which a pose counts as tilted",
             CHOICE, acts_by=_corrected),
    Constant("hypotheses", "laws", "_LEAST_LENGTHS", "different lengths of a cable that periodic errors need", CHOICE,
             acts_by=_laws),
    Constant("diagnosis", "diagnosing", "KEEPS", "log evidence that a cause must keep without the block of data it "
             "needs most [nat]", CHOICE, beside=True),
    Constant("diagnosis", "diagnosing", "_LEAST", "probability of any cause below which a significant error is left to "
             "outliers", CHOICE, beside=True),
    Constant("diagnosis", "left_out", "_CONCERNED", "share of the rows, at least, that the gain of a better model is "
             "stated for", CHOICE, beside=True),
    Constant("diagnosis", "damping_law", "MODEL_SHARE", "model error of a mode's damping ratio, relative", CHOICE,
             tried="damping"),
    Constant("diagnosis", "damping_rows", "_BETTER", "sigma of a whole record over that of its windows below which the "
             "record counts", CHOICE, tried=""),
    Constant("planning", "campaign_plan", "_VISIBLE", "sigmas by which a cause of its prior size must change planned "
             "data", CONVENTION, tried="plans"),
    Constant("planning", "places", "STEP", "proposed step to another pose over the frame's width, and of a payload "
             "over the platform's mass", CHOICE, tried="plans",
             follows=((_PLACES, "RAISED", lambda s: 2.0 * s), (_PLACES, "STEP_LOAD", lambda s: 2.0 * s),
                      (_PLACES, "PAYLOADS", lambda s: (s, 2.0 * s, 3.0 * s)),
                      (_PLACES, "LOCKED", lambda s: (0.0, s, 2.0 * s)))),
    Constant("planning", "places", "TILT", "proposed tilt of the platform [rad]: 10 degrees", CHOICE, tried="plans"),
)  # fmt: skip


@contextmanager
def changed(constant: Constant, factor: float) -> Iterator[None]:
    """The constant times a factor in every module that holds it, and what is computed from it."""
    new = constant.scaled(constant.value, factor)
    put = [(constant.module, constant.name, new), *((m, n, of(new)) for m, n, of in constant.follows)]
    before: list[tuple[Any, str, Any]] = []
    for module, name, value in put:
        old = getattr(import_module(module), name)
        for holder in _holding(name, old):
            before.append((holder, name, old))
            setattr(holder, name, value)
    noncentrality.cache_clear()
    try:
        yield
    finally:
        for holder, name, old in before:
            setattr(holder, name, old)
        noncentrality.cache_clear()


def _holding(name: str, value: Any) -> list[Any]:
    """Modules of the package that hold this very object under this name."""
    return [
        module
        for key, module in list(sys.modules.items())
        if key.startswith("cdpr_struct.") and getattr(module, name, None) is value
    ]
