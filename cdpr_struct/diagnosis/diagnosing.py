"""The whole diagnosis of a campaign."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis import stories
from cdpr_struct.diagnosis.added_modes import least_evidence
from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.common_first import common_first
from cdpr_struct.diagnosis.damped import NEEDS_SIGNALS, Damped, damped
from cdpr_struct.diagnosis.decision import Decision, decided
from cdpr_struct.diagnosis.detectable_sizes import detectable_sizes
from cdpr_struct.diagnosis.diagnosis import (
    DAMPING,
    NULL_SPACE,
    Candidate,
    Diagnosis,
    Location,
    Peaks,
    Pile,
    SetAside,
)
from cdpr_struct.diagnosis.errors_of_kinds import errors_of_kinds, located
from cdpr_struct.diagnosis.extended import extended_robot, unexplained_robot
from cdpr_struct.diagnosis.generic_fit import generic_ratio
from cdpr_struct.diagnosis.internal_forces import InternalForces, internal_forces
from cdpr_struct.diagnosis.left_out import LeftOut, left_out, rows_of
from cdpr_struct.diagnosis.peaks_apart import PeaksApart, peaks_apart
from cdpr_struct.diagnosis.piled_up import piled_up
from cdpr_struct.diagnosis.recommended import Recommendation, recommended
from cdpr_struct.diagnosis.recording import Recording, pieces_of, recording
from cdpr_struct.diagnosis.remainder import remainder
from cdpr_struct.diagnosis.sensor_sigmas import NoiseOfKind, doubts, noise_of_kinds, noise_of_peaks, sigmas_used
from cdpr_struct.diagnosis.set_aside import set_aside
from cdpr_struct.diagnosis.unassigned import peak_count, uncertain_peaks
from cdpr_struct.diagnosis.whole_sizes import WholeSize, whole_sizes
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.library import require_known
from cdpr_struct.hypotheses.explain import Belief, Explained, believed, explained
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.significant import SIGNIFICANT
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.residuals.condensed import condensed
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot import Robot

KEEPS = 1.0  # nats that a cause must keep without the block of data that it needs most: else it explains that block
TOO_SMALL = "in these data it is masked by noise and tolerances at any size"
_UNUSED = "The robot's frequencies are not used: at the poses as entered,"
_LEAST = 0.03  # probability that anything is wrong, below which outliers explain what is significant
_MOSTLY, _OPEN = 0.5, 4  # of it an unknown law must hold so much to be spoken of; else so many causes are left open
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
    require_known(campaign.source, campaign.checked)
    whole, campaign = campaign, condensed(campaign)
    campaign, found = _explained(campaign, budget, progress)
    told = {id(one): stories.candidates(one) for one in found}
    beliefs = believed(found)
    hidden = stories.without_size(found, list(told.values()))
    loss = campaign.loss if loss is None else loss
    decision = _decided(beliefs, loss, hidden, stories.p_value(found))
    decision, story, moved, pile = _weighed(whole, campaign, found, decision)
    progress("predicting what was left out")
    answer = _Said.of(campaign, story, decision, loss)
    rows = told[id(story)] if id(story) in told else stories.candidates(story)
    return _assembled(found, beliefs, answer, rows, pile, moved)


def _weighed(
    whole: Campaign, campaign: Campaign, found: Sequence[Explained], decision: Decision
) -> tuple[Decision, Explained, Recording | None, Pile | None]:
    """The decision with what outliers and frames of a motion say of it, the story that it believes, and those two.

    whole : the campaign with all its frames
    """
    frames = _all_frames(whole, campaign, found[0])
    beside = None if frames is None else remainder(frames, pieces_of(frames, found[0]), found, decision)
    decision = decision if beside is None else beside.decision
    story = stories.believed_data(found, decision)
    pile = piled_up(story.search.data, story.search.where, stories.chosen_of(story, decision))
    if pile is not None:
        decision, beside = Decision(UNKNOWN, (), 1.0 - pile.p), None
    frames = frames if story is found[0] else _all_frames(whole, campaign, story)
    story = common_first(story, stories.chosen_of(story, decision))
    null, chosen = stories.null_of(story).best, stories.chosen_of(story, decision)
    moved = recording(campaign, frames, story, null, chosen, beside)
    if moved is not None and moved.unnamed_motion and decision.classes:
        decision = Decision(UNKNOWN, (), 1.0 - moved.p_of_unnamed)
    return decision, story, moved, pile


def _all_frames(whole: Campaign, campaign: Campaign, story: Explained) -> AllFrames | None:
    """Of a campaign as recorded; of corrected data those that were fitted."""
    every = campaign.frames is not None and story.correction is None
    return AllFrames.of(recorded(whole) if every else story.search.data)


def _explained(campaign: Campaign, budget: str, progress: Callable[[str], None]) -> tuple[Campaign, list[Explained]]:
    """The campaign with what may be wrong; without the robot's peaks if it cannot stand at the poses entered."""
    try:
        return campaign, explained(campaign, BUDGETS[budget], progress)
    except UnstableEquilibriumError as error:
        states = campaign.states
        if not (np.isfinite(states.tension).any() or np.isfinite(states.length).any()):
            raise
        without = replace(campaign.without_robot_peaks(), notes=(*campaign.notes, f"{_UNUSED} {error}."))
        return without, explained(without, BUDGETS[budget], progress)


def _decided(beliefs: Sequence[Belief], loss: Loss, hidden: set[str], p_value: float) -> Decision:
    """All is well if nothing is significant, and only then: else what is least wrong of the rest, never by name."""
    wrong = [one for one in beliefs if one.names]
    share = sum(one.probability for one in wrong)
    if p_value >= SIGNIFICANT:
        return Decision("adequate", (), min(1.0, max(0.0, 1.0 - share)))
    decision = decided(beliefs, loss, hidden)
    if decision.status != "adequate" or share < _LEAST:
        return decision
    rest = decided([Belief(one.names, one.probability / share) for one in wrong], loss, hidden)
    if rest.status not in ("adequate", UNKNOWN):
        return Decision("class", rest.classes, rest.probability * share)
    alone = sorted((one for one in wrong if len(one.names) == 1), key=lambda one: -one.probability)
    names = [one.names[0] for one in alone if not {UNKNOWN, *hidden} & set(one.names)][:_OPEN]
    if not names or (rest.status == UNKNOWN and rest.probability > _MOSTLY):
        return Decision(UNKNOWN, (), share)
    held = sum(one.probability for one in wrong if set(names) & set(one.names))
    return Decision("class", (tuple(names),), held)


@dataclass(frozen=True, slots=True, eq=False)
class _Said:
    """What a decision says of the data that it believes, and what other data say of that."""

    campaign: Campaign
    story: Explained
    decision: Decision
    null: Judged
    chosen: Judged
    sizes: tuple[WholeSize, ...]
    left: LeftOut | None
    added: float | None
    confirmed: bool
    robot: Robot | None
    damped: Damped | None
    forces: InternalForces | None
    apart: PeaksApart | None

    @classmethod
    def of(cls, campaign: Campaign, story: Explained, decision: Decision, loss: Loss) -> "_Said":
        data, where = story.search.data, story.search.where
        null, chosen = stories.null_of(story).best, stories.chosen_of(story, decision)
        left = left_out(data, where, chosen) if decision.classes else None
        added = least_evidence(data, where, chosen) if decision.classes else None
        confirmed = _confirmed(chosen, left, added) if decision.classes else True
        sizes = tuple(whole_sizes(data, story.search.seen, chosen))
        robot = _extended(story, decision, sizes, chosen)
        doubtful = Decision("class", decision.classes, min(decision.probability, loss.least_said))
        by_signals = damped(campaign, robot, loss)
        said = decision if confirmed else doubtful
        forces = internal_forces(data, where, chosen, noise_of_kinds(chosen))
        apart = peaks_apart(story.search)
        return cls(
            campaign, story, said, null, chosen, sizes, left, added, confirmed, robot, by_signals, forces, apart
        )  # fmt: skip

    @property
    def fitted(self) -> Decision:
        """The decision on what was fitted; where nothing is wrong there, on peaks far from modes, or the damping."""
        if self.decision.status == "adequate" and self.apart is not None and self.apart.found:
            return Decision("class", (self.apart.names,), 1.0 - self.apart.p)
        return self.damped.decision if self.damped is not None and self._by_damping else self.decision

    @property
    def whole(self) -> Decision:
        """The same with what encoders and load cells together say of the internal forces."""
        fitted, forces = self.fitted, self.forces
        known = {name for names in fitted.classes for name in names}
        if forces is None or not forces.found or internal_force.CAUSE.name in known or fitted.status == UNKNOWN:
            return fitted
        own = ((internal_force.CAUSE.name,),)
        if fitted.status == "adequate":
            return Decision("named", own, forces.probability)
        return Decision(fitted.status, (*fitted.classes, *own), min(fitted.probability, forces.probability))

    @property
    def location(self) -> Location | None:
        """Where the error sits."""
        if self.decision.status != "adequate":
            return located(self.story, self.null, self.chosen)
        if self.apart is not None and self.fitted.classes == (self.apart.names,):
            return Location("RF", self.apart.lists[0].case, -1)
        if self._by_damping:
            return Location(DAMPING, "", -1)
        if self.forces is None or self.whole == self.fitted:
            return None
        split, names = self.forces.split, self.campaign.states.names
        return Location(NULL_SPACE, names[int(split.state[split.internal_rms.argmax()])], -1)

    @property
    def _by_damping(self) -> bool:
        return self.decision.status == "adequate" and self.damped is not None and self.damped.stands_out


def _confirmed(chosen: Judged, left: LeftOut | None, added: float | None) -> bool:
    """Whether every cause keeps evidence without the data that it needs most; a single state cannot say."""
    tuned = {part.cause.tuned for part in chosen.hypothesis.parts}
    usual = False not in tuned or (left is not None and bool((left.kept >= KEEPS).all()))
    return usual and (True not in tuned or (added is not None and added >= KEEPS))


def _assembled(
    found: Sequence[Explained], beliefs: Sequence[Belief], said: _Said, rows: Sequence[Candidate], pile: Pile | None,
    moved: Recording | None,
) -> Diagnosis:  # fmt: skip
    """Everything of a diagnosis."""
    story, null, chosen, campaign = said.story, said.null, said.chosen, said.campaign
    data, search, recorded = story.search.data, story.search, stories.as_recorded(found)
    least, by_pattern = detectable_sizes(search, null)
    unseen = {cause.name: TOO_SMALL for cause in search.causes if not (cause.name in least or cause.tuned)}
    aside = tuple(set_aside(data, search.where, chosen))
    noise = [*noise_of_kinds(chosen), *noise_of_peaks(chosen)]
    fitted, decision = said.fitted, said.whole
    by_forces = said.forces.p if said.forces is not None and decision != fitted else 1.0
    by_peaks = said.apart.p if said.apart is not None and said.apart.found else 1.0
    advice = recommended(fitted if by_peaks < 1.0 else said.decision, said.confirmed, _likeliest(rows))
    return Diagnosis(
        campaign=campaign, decision=decision, beliefs=tuple(sorted(beliefs, key=lambda one: -one.probability)),
        p_value=min(stories.p_value(found), by_forces, by_peaks, 1.0 if pile is None else pile.p), piled_up=pile,
        p_adequate=_p_adequate(noise), explained=story, correction=story.correction,
        chosen=chosen, null=null, sizes=said.sizes if moved is None else moved.widened(said.sizes),
        drift=stories.drift_of(story, chosen), candidates=tuple(rows),
        tried=tuple(stories.tried(found, story)), set_aside=aside,
        peaks=Peaks(peak_count(data), tuple(uncertain_peaks(data, chosen))), noise=tuple(noise),
        errors=tuple(errors_of_kinds(recorded)), location=said.location,
        recorded=_rows(recorded, stories.null_of(recorded).best), residuals=_rows(story, chosen), left_out=said.left,
        generic=None if said.left is None else generic_ratio(search, null, chosen), added=said.added,
        confirmed=said.confirmed, extended=said.robot, damped=said.damped, forces=said.forces, apart=said.apart,
        fitted=fitted, recommendations=(*advice, *_again(aside)),
        sigmas=tuple(sigmas_used(campaign)), doubts=tuple(doubts(campaign, noise)),
        not_testable=search.hidden | unseen | ({} if campaign.identified else NEEDS_SIGNALS), minimum_detectable=least,
        detectable_by_pattern=by_pattern, recording=moved,
    )  # fmt: skip


def _rows(story: Explained, found: Judged) -> LeftOut:
    """Residuals with their sigmas as stated."""
    return rows_of(story.search.data, story.search.where, found, NoiseState.stated(found.model.groups))


def _extended(story: Explained, decision: Decision, sizes: Sequence[WholeSize], chosen: Judged) -> Robot | None:
    """The robot with what the decision names, and how sure its numbers are; after `unknown`, with what is left."""
    if decision.status == UNKNOWN:
        return unexplained_robot(story.search.data, story.search.where, stories.null_of(story).best)
    if not decision.classes:
        return None
    own = [] if story.correction is None else [story.correction.cause]
    return extended_robot(story.search.data, sizes, [*own, *(size.part.cause.name for size in sizes)], chosen)


def _p_adequate(noise: Sequence[NoiseOfKind]) -> float:
    """The least probable of the kinds' noise, times how many kinds were looked at."""
    return min(1.0, len(noise) * min((one.p_large for one in noise), default=1.0))


def _likeliest(rows: Sequence[Candidate]) -> list[str]:
    """The best causes that were fitted alone."""
    return [row.names[0] for row in rows if len(row.names) == 1 and row.has_size][:_LIKELIEST]


def _again(aside: Sequence[SetAside]) -> list[Recommendation]:
    """Readings that contradict all others are to be read again."""
    places = ((one.kind, one.case, one.cable, one.hertz) for one in aside)
    return [Recommendation("repeat", "", kind=k, case=case, cable=i, hertz=f) for k, case, i, f in places]
