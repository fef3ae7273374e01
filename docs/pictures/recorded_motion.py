"""A recording by others: lengths against speed before and after, by stretch, and in frames that were not fitted."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import cdpr_struct as cs
from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, ORANGE, VERMILLION
from cdpr_struct.residuals.recorded import recorded

DOCS = Path(__file__).parents[1]
FOLDER = DOCS.parent / "examples" / "recorded-motion"
NUMBERS = DOCS / "recorded_motion.json"
SIZE = (9.6, 6.4)
_MM, _MS = 1e3, 1e3
_EVERY = 3  # frames between those that are drawn against speed
_SHOWN = 2  # cable whose later frames are drawn, from 0


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The diagnosis of the first frames, and the lengths of the later ones.

    time (F,) [s];  speed, entered, named (F, m) : of the later frames [m/s], [m]
    """

    result: Any
    time: np.ndarray
    speed: np.ndarray
    entered: np.ndarray
    named: np.ndarray

    def numbers(self) -> dict[str, Any]:
        """What the page says."""
        told = self.result.answer
        size = next(iter(told["candidates"][0]["parameters"].values()))
        keys = ("frames", "states", "independent_frames", "stretches_chi2_per_dof", "sigma_factor",
                "explained_by_speed", "explained_by_acceleration", "bend_of_speed", "remainder")  # fmt: skip
        return {
            "status": told["verdict"]["status"], "causes": told["verdict"]["causes"],
            "delay_ms": _MS * size["value"], "sigma_ms": _MS * size["sigma"],
            **{key: told["recording"][key] for key in keys},
            "stretches_ms": [
                [_MS * one["estimate"][0], _MS * one["sigma"][0]] for one in told["recording"]["stretches"]
            ],
            "later_mm": [
                [row[key] for key in ("as_entered_mm", "tolerances_fitted_mm", "with_causes_mm")]
                for row in told["later_lengths"]["cables"]
            ],
        }  # fmt: skip


def found() -> Found:
    """Fitted to `fitted.csv`, held against `later.csv`."""
    later = cs.load_campaign(FOLDER / "later.toml")
    result = cs.diagnose(FOLDER / "campaign.toml", later=later)
    every = AllFrames.read(recorded(later))
    speed, chosen = every.data.known.rate[every.frames, :, 0], result.diagnosis.chosen
    return Found(result, every.time, speed, every.errors(None), every.errors(chosen))


def written(one: Found) -> None:
    """The numbers that the page is held against."""
    rounded = json.loads(json.dumps(one.numbers()), parse_float=lambda text: round(float(text), 4))
    NUMBERS.write_text(json.dumps(rounded, indent=1) + "\n", encoding="utf-8")


def draw(figure: Figure, one: Found) -> None:
    """Four panels."""
    grid = figure.add_gridspec(2, 2)
    _against_speed(figure.add_subplot(grid[0, 0]), one)
    _by_stretch(figure.add_subplot(grid[0, 1]), one)
    _in_time(figure.add_subplot(grid[1, 0]), one)
    _by_cable(figure.add_subplot(grid[1, 1]), one)


def _against_speed(axes: Axes, one: Found) -> None:
    for errors, colour, words in ((one.entered, VERMILLION, "as entered"), (one.named, BLUE, "with the delay")):
        centred = errors - errors.mean(axis=0)
        some = slice(None, None, _EVERY)
        axes.plot(one.speed[some].ravel(), _MM * centred[some].ravel(), ".", ms=2.5, color=colour, label=words)
    reach = np.array([-1.0, 1.0]) * np.abs(one.speed).max()
    axes.plot(reach, one.numbers()["delay_ms"] * reach, color=BLACK, lw=0.9, label="slope: the delay found")
    axes.set(title="Later frames, all cables", xlabel="speed of the cable [m/s]", ylabel="length error [mm]")
    axes.legend(loc="upper left")


def _by_stretch(axes: Axes, one: Found) -> None:
    numbers, told = one.numbers(), one.result.answer["recording"]["stretches"]
    value, sigma = numbers["delay_ms"], numbers["sigma_ms"]
    axes.axhspan(value - sigma, value + sigma, color=BLUE, alpha=0.2, lw=0.0, label="all stretches, one sigma")
    middle = [0.5 * (row["start_s"] + row["end_s"]) for row in told]
    own, spread = np.array(numbers["stretches_ms"]).T
    axes.errorbar(middle, own, spread, fmt="o", ms=4, color=BLACK, lw=1.0, label="one stretch on its own")
    room = (float((own - spread).min()) - 1.0, float((own + spread).max()) + 4.0)
    axes.set(title="Delay by stretch of the fitted frames", xlabel="time [s]", ylabel="delay [ms]", ylim=room)
    axes.legend(loc="upper right")


def _in_time(axes: Axes, one: Found) -> None:
    for errors, colour, words in ((one.entered, VERMILLION, "as entered"), (one.named, BLUE, "with the delay")):
        axes.plot(one.time, _MM * errors[:, _SHOWN], color=colour, lw=1.0, label=words)
    axes.axhline(0.0, color=GREY, lw=0.6)
    axes.set(title=f"Later frames, cable {_SHOWN + 1}", xlabel="time [s]", ylabel="length error [mm]")
    axes.legend(loc="upper right")


def _by_cable(axes: Axes, one: Found) -> None:
    rows = np.array(one.numbers()["later_mm"])
    words = ("as entered", "tolerances fitted", "with the delay")
    for k, (word, colour) in enumerate(zip(words, (VERMILLION, ORANGE, BLUE), strict=True)):
        axes.bar(np.arange(len(rows)) + 0.27 * (k - 1), rows[:, k], 0.25, color=colour, label=word)
    axes.set_xticks(np.arange(len(rows)), [f"cable {i + 1}" for i in range(len(rows))])
    axes.set(title="Later frames, rms", ylabel="length error [mm]", ylim=(0.0, 1.35 * float(rows.max())))
    axes.legend(loc="upper right", ncols=1)
