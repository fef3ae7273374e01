"""Rows of several files become states: the same case in two files is the same state with the same readings."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.assumed_angles import angle_note
from cdpr_struct.measurement.cable_columns import SWIVEL
from cdpr_struct.measurement.campaign import (
    AMBIENT,
    NOT_SAID,
    SIGNALS,
    CableFrequencies,
    RobotFrequencies,
    Series,
    Sigmas,
    States,
)
from cdpr_struct.measurement.campaign_rows import POSE, POSITION, Rows, length_columns
from cdpr_struct.measurement.peak_labels import peak_label
from cdpr_struct.measurement.swivel_readings import take_swivel

_SAME = 1e-9  # m, deg: two notes of the same number
_ONE_STATE = "one case is one state: copy the digits, leave the cells empty, or give this case another name"


@dataclass(slots=True)
class _State:
    """A case: `file` gave its pose first, `length_file` its lengths, `tension_file` its tensions ("": none)."""

    name: str
    file: str
    pose: np.ndarray
    payload: float
    sigma_position: float
    sigma_rotation: float
    tension: np.ndarray
    tension_sigma: np.ndarray
    length: np.ndarray
    length_sigma: np.ndarray
    approach: np.ndarray
    temperature: float
    time: float
    swivel: np.ndarray
    swivel_sigma: np.ndarray
    loaded: bool = False
    static: bool = False
    length_file: str = ""
    tension_file: str = ""


@dataclass(slots=True)
class Gathering:
    """Collects the rows of all files of a campaign for a robot with m cables."""

    m: int
    known: dict[str, _State] = field(default_factory=dict)
    cable_rows: list[tuple[int, int, int, bool, float, float]] = field(default_factory=list)
    robot_rows: list[tuple[int, float, float, int, int]] = field(default_factory=list)
    series: list[tuple[Series, Sigmas]] = field(default_factory=list)
    ambient: list[tuple[Series, Sigmas]] = field(default_factory=list)
    shapes: dict[int, np.ndarray] = field(default_factory=dict)
    origins: dict[int, tuple[int, int]] = field(default_factory=dict)

    def add(self, rows: Rows, sigmas: Sigmas) -> None:
        """Take in the rows of one file.

        Raises
        ------
        InputError : a case with two poses or payloads, a cable given twice or not at all.
        """
        if rows.kind in SIGNALS:
            self.series.append((_series(rows), sigmas))
            return
        if rows.kind == AMBIENT:
            self._ambient(rows, sigmas)
            return
        states = [self._state(rows, i, sigmas) for i in range(len(rows))]
        if rows.kind == "static_state":
            self._static(rows, states, sigmas)
        elif rows.kind == "loaded_pose":
            self._loaded(rows, states, sigmas)
        elif rows.kind == "cable_frequency":
            self._cable_frequency(rows, states, sigmas)
        else:
            self._robot_frequency(rows, states, sigmas)

    def _state(self, rows: Rows, i: int, sigmas: Sigmas) -> _State:
        name = rows.words["case"][i]
        placed = any(name in rows.numbers for name in POSITION)
        unsaid = 0.0 if placed else np.nan  # nan: another file says it of the state of this name
        pose = np.array([rows.get(c, unsaid)[i] for c in POSE])
        payload = float(rows.get("payload_kg", unsaid)[i])
        found = self.known.get(name)
        if found is None:
            found = self._new(name, rows.file, pose, payload, sigmas)
            found.temperature, found.time = float(rows.get("temperature_K")[i]), float(rows.get("time_s")[i])
        elif _differ(np.append(found.pose, found.payload), np.append(pose, payload)):
            before = [*found.pose.tolist(), found.payload]
            expected = f"the pose and payload given before for this case in {Path(found.file).name}, {before}"
            expected += f": {_ONE_STATE}"
            if _thousandfold(found.pose, pose):
                expected += " (is one of the two positions in mm?)"
            if note := angle_note("this file", list(rows.numbers)):
                expected += f" ({note.removesuffix('.')})"
            raise InputError(rows.file, f"{rows.place(i)}, case {name}", [*pose.tolist(), payload], expected)
        found.pose = np.where(np.isfinite(found.pose), found.pose, pose)
        found.payload = found.payload if np.isfinite(found.payload) else payload
        return found

    def _new(self, name: str, file: str, pose: np.ndarray, payload: float, sigmas: Sigmas) -> _State:
        blank = np.full((7, self.m), np.nan)
        self.known[name] = _State(
            name, file, pose, payload, sigmas.position_m, float(np.radians(sigmas.rotation_deg)),
            blank[0], blank[1], blank[2], blank[3], blank[4], np.nan, np.nan,
            blank[5], blank[6],
        )  # fmt: skip
        return self.known[name]

    def add_frequencies(
        self, case: str, pose: np.ndarray, payload: float, lengths: np.ndarray, sigmas: Sigmas,
        frequencies: list[tuple[float, float, np.ndarray, tuple[int, int]]],
    ) -> None:  # fmt: skip
        """Robot frequencies (Hz, sigma, shape, origin) that signals of a case gave; the case becomes a state.

        pose : (6,) [m, deg];  lengths : (m,) [m], nan if not read
        """
        state = self.known.get(case)
        if state is None:
            state = self._new(case, "", pose, payload, sigmas)
            state.length, state.length_sigma = lengths, np.full(self.m, sigmas.length_m)
        place = list(self.known).index(case)
        for hertz, sigma, shape, origin in frequencies:
            self.origins[len(self.robot_rows)] = origin
            self.shapes[len(self.robot_rows)] = shape
            self.robot_rows.append((place, hertz, sigma, NOT_SAID, NOT_SAID))

    def _ambient(self, rows: Rows, sigmas: Sigmas) -> None:
        """Ambient records, whose cases are states; their clocks are not the campaign's."""
        names = rows.words["case"]
        timeless = replace(rows, numbers={k: v for k, v in rows.numbers.items() if k != "time_s"})
        for case in dict.fromkeys(names):
            self._state(timeless, names.index(case), sigmas)
        self.ambient.append((_series(rows), sigmas))

    def ambient_states(self) -> np.ndarray:
        """Numbers of the states that have an ambient record."""
        order = {name: i for i, name in enumerate(self.known)}
        return np.array([order[c] for s, _ in self.ambient for c in dict.fromkeys(s.case)], dtype=int)

    def _static(self, rows: Rows, states: list[_State], sigmas: Sigmas) -> None:
        own = rows.get("sigma")
        has_tension, has_length = "tension_N" in rows.numbers, "length_m" in rows.numbers
        seen = set()
        for i, state in enumerate(states):
            cable = int(rows.numbers["cable"][i]) - 1
            if (state.name, cable) in seen:
                raise _twice(rows, i, state.name)
            seen.add((state.name, cable))
            state.static = True
            given = own[i] if np.isfinite(own[i]) else None
            if has_tension or not state.tension_file:
                state.tension[cable] = rows.get("tension_N")[i]
                state.tension_sigma[cable] = given or sigmas.tension_N
                state.tension_file = rows.file if has_tension else ""
            if has_length or not state.length_file:
                state.length[cable] = rows.get("length_m")[i]
                state.length_sigma[cable] = sigmas.length_m if has_tension else given or sigmas.length_m
                state.length_file = rows.file if has_length else ""
            if "approach" in rows.numbers:
                state.approach[cable] = rows.numbers["approach"][i]
            take_swivel(state, rows, i, cable, rows.get("swivel_deg")[i], sigmas.swivel_deg)

    def _loaded(self, rows: Rows, states: list[_State], sigmas: Sigmas) -> None:
        own = rows.get("sigma")
        for i, state in enumerate(states):
            length = np.array([rows.numbers[c][i] for c in length_columns(self.m)])
            state.loaded = True
            if _differ(state.length, length):
                raise _other_length(rows, i, state, length)
            state.length_file = rows.file
            state.length = np.where(np.isfinite(length), length, state.length)
            state.length_sigma = np.full(self.m, sigmas.length_m)
            state.sigma_position = own[i] if np.isfinite(own[i]) else sigmas.position_m
            for cable, name in enumerate(SWIVEL.columns(self.m)):
                take_swivel(state, rows, i, cable, rows.get(name)[i], sigmas.swivel_deg)

    def _cable_frequency(self, rows: Rows, states: list[_State], sigmas: Sigmas) -> None:
        order = {name: i for i, name in enumerate(self.known)}
        own, planes = rows.get("sigma"), rows.words.get("plane", [""] * len(rows))
        for i, state in enumerate(states):
            cable, hertz = int(rows.numbers["cable"][i]) - 1, rows.numbers["frequency_hz"][i]
            sigma = own[i] if np.isfinite(own[i]) else float(sigmas.frequency(np.array(hertz)))
            mode = int(rows.numbers["mode"][i])
            self.cable_rows.append((order[state.name], cable, mode, planes[i] != "out", hertz, sigma))
            tension = rows.get("tension_N")[i]
            if np.isfinite(tension) and not np.isfinite(state.tension[cable]):
                state.tension[cable], state.tension_sigma[cable] = tension, sigmas.tension_N
                state.tension_file = rows.file

    def _robot_frequency(self, rows: Rows, states: list[_State], sigmas: Sigmas) -> None:
        order = {name: i for i, name in enumerate(self.known)}
        own = rows.get("sigma")
        for i, state in enumerate(states):
            hertz = rows.numbers["frequency_hz"][i]
            sigma = own[i] if np.isfinite(own[i]) else float(sigmas.frequency(np.array(hertz)))
            self.robot_rows.append((order[state.name], hertz, sigma, *peak_label(rows, i, self.m)))

    def tension_files(self) -> dict[str, str]:
        """The file that gave the tensions of each case."""
        return {name: state.tension_file for name, state in self.known.items()}

    def states(self) -> States:
        """All states, in the order of their first appearance."""
        found = list(self.known.values())
        length = np.array([s.length for s in found]).reshape((-1, self.m))
        return States(
            names=tuple(s.name for s in found),
            position=np.array([s.pose[:3] for s in found]).reshape((-1, 3)),
            angles=np.radians(np.array([s.pose[3:] for s in found]).reshape((-1, 3))),
            sigma_position=np.array([s.sigma_position for s in found]),
            sigma_rotation=np.array([s.sigma_rotation for s in found]),
            payload=np.nan_to_num([s.payload for s in found]),
            tension=np.array([s.tension for s in found]).reshape((-1, self.m)),
            tension_sigma=np.array([s.tension_sigma for s in found]).reshape((-1, self.m)),
            length=length,
            length_sigma=np.array([s.length_sigma for s in found]).reshape((-1, self.m)),
            lock=_locks(length),
            loaded=np.array([s.loaded for s in found], dtype=bool),
            static=np.array([s.static for s in found], dtype=bool),
            temperature=np.array([s.temperature for s in found]),
            approach=np.array([s.approach for s in found]).reshape((-1, self.m)),
            time=np.array([s.time for s in found]),
            swivel=np.array([s.swivel for s in found]).reshape((-1, self.m)),
            swivel_sigma=np.array([s.swivel_sigma for s in found]).reshape((-1, self.m)),
        )

    def cable_frequencies(self) -> CableFrequencies:
        """All frequencies of cables."""
        table = np.array(self.cable_rows, dtype=float).reshape((-1, 6))
        state, cable, mode = (table[:, i].astype(int) for i in range(3))
        return CableFrequencies(state, cable, mode, table[:, 3] > 0.5, table[:, 4], table[:, 5])

    def robot_frequencies(self) -> RobotFrequencies:
        """All frequencies of the robot."""
        table = np.array(self.robot_rows, dtype=float).reshape((-1, 5))
        shape = np.full((len(table), 6), np.nan, dtype=complex)
        for row, seen in self.shapes.items():
            shape[row] = seen
        origin = np.full((len(table), 2), -1)
        for row, made in self.origins.items():
            origin[row] = made
        body, mode = table[:, 3:].astype(int).T
        return RobotFrequencies(table[:, 0].astype(int), table[:, 1], table[:, 2], shape, origin, body, mode)


def _series(rows: Rows) -> Series:
    labels = {k: tuple(v) for k, v in rows.words.items() if k != "case"}
    return Series(rows.kind, rows.file, tuple(rows.words["case"]), dict(rows.numbers), labels)


def _other_length(rows: Rows, i: int, state: _State, length: np.ndarray) -> InputError:
    """A length of a case that differs from that of another file, or of another row."""
    cable = next(k for k in range(len(length)) if _differ(state.length[k : k + 1], length[k : k + 1]))
    place = f"{rows.place(i)}, case {state.name}, column {length_columns(len(length))[cable]}"
    expected = f"in {Path(state.length_file).name} this case has {state.length[cable]:.12g}; {_ONE_STATE}"
    return InputError(rows.file, place, float(length[cable]), expected)


def _twice(rows: Rows, i: int, case: str) -> InputError:
    """A cable of a case that is given again in row i."""
    if rows.row:
        expected = "one row a pose; give a repeated measurement a case of its own (column case)"
        return InputError(rows.file, f"{rows.place(i)}, case {case}", "a second row of this case", expected)
    cable = int(rows.numbers["cable"][i])
    return InputError(rows.file, f"{rows.place(i)}, column cable", cable, f"one row a cable in {case}")


def _thousandfold(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two poses (6,) look alike but for a factor of 1000 in the position."""
    near, far = sorted(float(np.linalg.norm(pose[:3])) for pose in (one, other))
    return near > 0.0 and abs(far / near - 1e3) < 1.0


def _differ(before: np.ndarray, after: np.ndarray) -> bool:
    """Whether two notes of the same numbers contradict each other; what was not noted, nan, contradicts nothing."""
    both = np.isfinite(before) & np.isfinite(after)
    return bool((np.abs(before - after)[both] > _SAME).any())


def _locks(length: np.ndarray) -> np.ndarray:
    """(S,) number of the lock of each state, -1 without lengths: equal lengths of the same cables are one lock."""
    found: dict[tuple[float, ...], int] = {}
    locks = []
    for row in length:
        read = tuple(np.where(np.isfinite(row), row, np.inf).tolist())
        locks.append(found.setdefault(read, len(found)) if np.isfinite(read).any() else -1)
    return np.array(locks, dtype=int)
