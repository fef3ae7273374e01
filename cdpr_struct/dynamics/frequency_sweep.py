"""A frequency response with everything that is needed to read it: its peaks, and the eigenfrequencies in its band."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, CableModel, cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified
from cdpr_struct.dynamics.damping import Damping, ModalDamping
from cdpr_struct.dynamics.frequency_response import FrequencyResponse, Quantity, ResponseFunction, direct_response
from cdpr_struct.dynamics.modal_basis import loss_rates
from cdpr_struct.dynamics.modal_response import modal_response
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import MODES_OF_A_POINT, CablePort, Port
from cdpr_struct.dynamics.resonances import Lines, Resonances
from cdpr_struct.dynamics.response_peaks import NO_PEAKS, ResponsePeaks, response_peaks
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.undamped_poles import UNDAMPED_RATIO, undamped_poles
from cdpr_struct.errors import CdprError

MOST_MODES = 400
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class ModesInBand:
    """Undamped eigenfrequencies from zero to the top of a band.

    hertz     : (k,) ascending
    kinds     : k names, as `RitzModes.kinds`
    certified : an exact count proves that none is missing
    complete  : False if there are more than MOST_MODES; the list then ends before the band does
    """

    hertz: np.ndarray
    kinds: list[str]
    certified: bool
    complete: bool


@dataclass(frozen=True, slots=True, eq=False)
class ResponseSweep:
    """Frequency response, its peaks, the robot it belongs to, and the robot's modes.

    response : on the even lines of the band and on further ones that draw the peaks
    even     : (f,) bool, the lines that were asked for
    peaks    : of each response; none of a silent one
    silent   : (n,) bool, nothing but rounding: an acceleration below 1e-9 of the free platform's
    ratios   : (k,) damping ratio of each of `modes`, by the energy that it loses alone [-]
    """

    point: OperatingPoint
    model: CableModel
    response: FrequencyResponse
    even: np.ndarray
    peaks: tuple[ResponsePeaks, ...]
    silent: np.ndarray
    modes: ModesInBand
    ratios: np.ndarray

    @property
    def evenly(self) -> FrequencyResponse:
        """The response on the lines that were asked for."""
        all_ = self.response
        return FrequencyResponse(
            all_.hertz[self.even], all_.response[self.even], all_.excite, all_.respond, all_.quantity
        )


def sweep_response(
    point: OperatingPoint,
    model: CableModel,
    damping: Damping,
    excite: Port,
    respond: tuple[Port, ...],
    hertz: np.ndarray,
    quantity: Quantity = "acceleration",
    assembly: Assembly = "consistent",
) -> ResponseSweep:
    """Response over the band, its peaks, and the eigenfrequencies below its top; hertz (f,) [Hz] evenly spaced."""
    top = float(hertz[-1])
    cables = cable_dynamics(point, model, 2.0 * np.pi * top * ShakenRobot.margin(excite))
    modes, shapes = _modes_and_shapes(point, cables, top, assembly)
    force = ShakenRobot(point, cables, damping, excite, respond, quantity, assembly)
    function = force.function((float(hertz[0]), top), modes.hertz)
    neutral = modes.hertz == 0.0
    if neutral.any() and not hertz[0] > 0.0:
        raise CdprError(
            "the platform is free to move in some direction, so at 0 Hz the response has no bound: begin above"
        )
    losses = loss_rates(damping, cables.first_frequency, shapes)
    ratios = np.where(neutral, 0.0, losses / np.where(neutral, 1.0, 2.0 * shapes.omega))
    undamped = (ratios < UNDAMPED_RATIO) & ~neutral
    known_to = top if modes.complete else float(modes.hertz[-1])
    widths = np.where(undamped, 0.0, ratios) * modes.hertz
    resonances = Resonances(modes.hertz[~neutral], widths[~neutral], known_to)
    lines = resonances.lines(hertz)
    working = np.union1d(hertz, lines.hertz)
    first = FrequencyResponse(working, function.at(working), excite, respond, quantity)
    silent = _silent(point, first, np.isin(working, hertz))
    poles = undamped_poles(shapes, modes.hertz, undamped & (modes.hertz >= hertz[0]), excite, respond)
    peaks = _peaks(function, first, silent, resonances, poles)
    drawn = _drawn(function, first, hertz, lines, modes.hertz[~neutral], peaks)
    return ResponseSweep(point, model, drawn, np.isin(drawn.hertz, hertz), peaks, silent, modes, ratios)


@dataclass(frozen=True, slots=True, eq=False)
class ShakenRobot:
    """A robot that is shaken at one port and watched at others; cables : up to `margin` times the top of a band."""

    point: OperatingPoint
    cables: CableDynamics
    damping: Damping
    excite: Port
    respond: tuple[Port, ...]
    quantity: Quantity
    assembly: Assembly

    @staticmethod
    def margin(excite: Port) -> float:
        """Times the top of the band, up to which the cables are resolved.

        Where a cable itself is shaken its modal sum converges as slowly as 1 / number of modes, so more are taken.
        """
        return MODES_OF_A_POINT if isinstance(excite, CablePort) else 1.0

    def function(self, band: tuple[float, float], certified_hertz: np.ndarray) -> ResponseFunction:
        """The responses over a band [Hz]: a sum over modes where these have ratios of their own, else direct."""
        ports = self.excite, self.respond
        if not isinstance(self.damping, ModalDamping):
            law = self.damping
            return direct_response(self.point, self.cables, law, *ports, band, self.quantity, self.assembly)
        highest = 2.0 * np.pi * band[1] * max(0.5 * self.margin(self.excite), 1.0)  # an expansion holds twice as much
        return modal_response(
            self.point, self.cables, self.damping, *ports, highest, certified_hertz, self.quantity, self.assembly
        )


def _peaks(
    function: ResponseFunction,
    response: FrequencyResponse,
    silent: np.ndarray,
    resonances: Resonances,
    poles: list[np.ndarray],
) -> tuple[ResponsePeaks, ...]:
    peaks = [NO_PEAKS] * len(silent)
    heard = np.flatnonzero(~silent)
    own_poles = [poles[i] for i in heard]
    found = response_peaks(function, response.hertz, response.response, heard, resonances, own_poles)
    for i, own in zip(heard, found, strict=True):
        peaks[i] = own
    return tuple(peaks)


def _drawn(
    function: ResponseFunction,
    response: FrequencyResponse,
    even: np.ndarray,
    lines: Lines,
    modes: np.ndarray,
    peaks: tuple[ResponsePeaks, ...],
) -> FrequencyResponse:
    """The response on the even lines, on those about modes that show as peaks, on summits and half-power points."""
    summits = np.concatenate([own.hertz for own in peaks])
    shown = np.abs(summits[:, None] - modes).argmin(axis=1) if len(modes) else np.zeros(0)
    kept = np.union1d(even, lines.hertz[np.isin(lines.mode, shown)])
    more = np.setdiff1d(np.concatenate([own.lines for own in peaks]), response.hertz)
    hertz = np.concatenate([kept, more])
    known = response.response[np.searchsorted(response.hertz, kept)]
    values = np.concatenate([known, function.at(more)]) if len(more) else known
    order = np.argsort(hertz)
    return FrequencyResponse(hertz[order], values[order], response.excite, response.respond, response.quantity)


def _silent(point: OperatingPoint, found: FrequencyResponse, even: np.ndarray) -> np.ndarray:
    """(n,) responses that symmetry makes zero. Their median is judged: resonances amplify rounding, too.

    even : (f,) bool, the lines that are judged
    """
    body = point.arrays
    gyration = float(np.sqrt(np.trace(body.inertia) / 3.0 / body.mass))
    omega = 2.0 * np.pi * found.hertz[even]
    rate = omega ** {"displacement": 2, "velocity": 1, "acceleration": 0}[found.quantity]
    turns = np.array([int(found.excite.turns) + int(port.turns) for port in found.respond])
    free = 1.0 / body.mass / gyration**turns
    middle = np.median(np.abs(found.response[even]) * rate[:, None], axis=0)
    return np.asarray(middle < _ROUNDING * free)


def modes_below(
    point: OperatingPoint, cables: CableDynamics, highest_hertz: float, assembly: Assembly = "consistent"
) -> ModesInBand:
    """Every eigenfrequency below `highest_hertz`, counted, with its kind."""
    return _modes_and_shapes(point, cables, highest_hertz, assembly)[0]


def _modes_and_shapes(
    point: OperatingPoint, cables: CableDynamics, highest_hertz: float, assembly: Assembly
) -> tuple[ModesInBand, RitzModes]:
    omega = 2.0 * np.pi * highest_hertz
    below = int(count_below(point, cables, np.array([omega]), assembly)[0])
    count = min(below, MOST_MODES)
    shapes = ritz_modes(point, cables.expansion(omega), count, assembly)
    if count == 0:
        return ModesInBand(np.zeros(0), [], True, True), shapes
    found = certified(point, cables, shapes, assembly)
    told = found.frequencies
    return ModesInBand(told.hertz, found.shapes.kinds(), told.certified, count == below), found.shapes
