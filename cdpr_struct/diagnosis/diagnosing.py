"""The whole diagnosis of a campaign."""

from collections.abc import Callable, Sequence

from cdpr_struct.diagnosis import stories
from cdpr_struct.diagnosis.damped import Damped, damped
from cdpr_struct.diagnosis.decision import Decision, decided
from cdpr_struct.diagnosis.detectable_sizes import minimum_detectable
from cdpr_struct.diagnosis.diagnosis import DAMPING, Candidate, Diagnosis, Location, Peaks, SetAside
from cdpr_struct.diagnosis.errors_of_kinds import errors_of_kinds, located
from cdpr_struct.diagnosis.explain import Explained, believed, explained
from cdpr_struct.diagnosis.extended import extended_robot
from cdpr_struct.diagnosis.generic_fit import generic_ratio
from cdpr_struct.diagnosis.judge import Judged
from cdpr_struct.diagnosis.left_out import LeftOut, left_out, rows_of
from cdpr_struct.diagnosis.recommended import Recommendation, recommended
from cdpr_struct.diagnosis.search import BUDGETS
from cdpr_struct.diagnosis.sensor_sigmas import NoiseOfKind, doubts, noise_of_kinds, sigmas_used
from cdpr_struct.diagnosis.set_aside import set_aside
from cdpr_struct.diagnosis.unassigned import peak_count, uncertain_peaks
from cdpr_struct.diagnosis.whole_sizes import WholeSize, whole_sizes
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.robot.robot import Robot

KEEPS = 1.0  # nats that a cause must keep without the block of data that it needs most: else it explains that block
HANGS = 0.6  # largest probability that is said of a cause that does not
_LIKELIEST = 3  # candidates that a recommendation speaks of where no cause explains the data


def diagnosed(
    campaign: Campaign,
    budget: str = "small",
    progress: Callable[[str], None] = lambda _: None,
    loss: Loss | None = None,
) -> Diagnosis:
    """Diagnose a campaign; `loss` in place of the campaign's own.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    found = explained(campaign, BUDGETS[budget], progress)
    told = {id(one): stories.candidates(one) for one in found}
    beliefs = believed(found)
    hidden = stories.without_size(found, list(told.values()))
    first = decided(beliefs, campaign.loss if loss is None else loss, hidden)
    story = stories.believed_data(found, first)
    null, chosen = stories.null_of(story).best, stories.chosen_of(story, first)
    progress("predicting what was left out")
    left = left_out(story.search.data, story.search.where, chosen) if first.classes else None
    confirmed = left is None or bool((left.kept >= KEEPS).all())
    decision = first if confirmed else Decision("class", first.classes, min(first.probability, HANGS))
    sizes = whole_sizes(story.search.data, story.search.seen, chosen)
    robot = _extended(story, first, sizes)
    by_damping = damped(campaign, robot)
    rows, recorded = told[id(story)], stories.as_recorded(found)
    noise = noise_of_kinds(chosen)
    data, where = story.search.data, story.search.where
    aside = tuple(set_aside(data, where, chosen))
    return Diagnosis(
        campaign=campaign,
        decision=_with_damping(decision, by_damping),
        beliefs=tuple(sorted(beliefs, key=lambda one: -one.probability)),
        p_value=stories.p_value(found),
        p_adequate=_p_adequate(noise),
        explained=story,
        correction=story.correction,
        chosen=chosen,
        null=null,
        sizes=tuple(sizes),
        drift=stories.drift_of(story, chosen),
        candidates=tuple(rows),
        tried=tuple(stories.tried(found, story)),
        set_aside=aside,
        peaks=Peaks(peak_count(data), tuple(uncertain_peaks(data, chosen))),
        noise=tuple(noise),
        errors=tuple(errors_of_kinds(recorded)),
        location=_location(story, decision, by_damping, null, chosen),
        recorded=_rows(recorded, stories.null_of(recorded).best),
        residuals=_rows(story, chosen),
        left_out=left,
        generic=generic_ratio(story.search, null, chosen) if left is not None else None,
        confirmed=confirmed,
        extended=robot,
        damped=by_damping,
        recommendations=tuple([*recommended(decision, confirmed, _likeliest(rows)), *_again(aside)]),
        sigmas=tuple(sigmas_used(campaign)),
        doubts=tuple(doubts(campaign, noise)),
        not_testable=story.search.hidden,
        minimum_detectable=minimum_detectable(story.search, null),
    )


def _rows(story: Explained, found: Judged) -> LeftOut:
    """Residuals with their sigmas as stated."""
    return rows_of(story.search.data, story.search.where, found, NoiseState.stated(found.model.groups))


def _extended(story: Explained, decision: Decision, sizes: Sequence[WholeSize]) -> Robot | None:
    """The robot with what the decision names."""
    if not decision.classes:
        return None
    own = [] if story.correction is None else [story.correction.cause]
    return extended_robot(story.search.data, sizes, [*own, *(size.part.cause.name for size in sizes)])


def _with_damping(decision: Decision, found: Damped | None) -> Decision:
    """The decision; where nothing else is wrong, that on the damping."""
    if decision.status == "adequate" and found is not None and found.stands_out:
        return found.decision
    return decision


def _location(
    story: Explained, decision: Decision, found: Damped | None, null: Judged, chosen: Judged
) -> Location | None:
    if decision.status != "adequate":
        return located(story, null, chosen)
    return Location(DAMPING, "", -1) if found is not None and found.stands_out else None


def _p_adequate(noise: Sequence[NoiseOfKind]) -> float:
    """The least probable of the kinds' noise, times how many kinds were looked at."""
    return min(1.0, len(noise) * min((one.p_large for one in noise), default=1.0))


def _likeliest(rows: Sequence[Candidate]) -> list[str]:
    """The best causes that were fitted alone."""
    return [row.names[0] for row in rows if len(row.names) == 1 and row.has_size][:_LIKELIEST]


def _again(aside: Sequence[SetAside]) -> list[Recommendation]:
    """Readings that contradict all others are to be read again."""
    return [Recommendation("repeat", "", kind=one.kind, case=one.case, cable=one.cable) for one in aside]
