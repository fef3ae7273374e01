"""One command for many inputs: each is answered by itself, on any worker, and one table says what came of them all."""

import json
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.cli.complaints import complaint
from cdpr_struct.cli.executors import Where
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.sweeping import run_work
from cdpr_struct.errors import InputError
from cdpr_struct.reports.plain_json import plain

Answer = Callable[..., tuple[Mapping[str, Any], Files]]
"""(input, *options) -> result.json and the other files of the command for one input; any process can run it."""
Row = dict[str, Any]


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What came of one input: a result with its files, or the exit code and the sentence of an error."""

    code: int
    message: str
    result: Mapping[str, Any]
    files: Files


def outcome(answer: Answer, given: str, *options: Any) -> Outcome:
    """The answer for one input; an error that a user can understand is an outcome, too."""
    try:
        result, files = answer(given, *options)
    except Exception as error:
        told = complaint(error)
        if told is None:
            raise
        return Outcome(*told, {}, {})
    return Outcome(0, "", result, files)


@dataclass(frozen=True, slots=True, eq=False)
class ManyInputs:
    """Many inputs of one command as a `WorkList`, each a part.

    noun        : what an input is, in the plural
    typed       : inputs as the command line has them; one may stand for several
    flag        : option before each of them, "" if there is none
    digests     : one an input, of all the files that its answer depends on
    fingerprint : of all that every answer depends on
    """

    noun: str
    inputs: tuple[str, ...]
    typed: tuple[str, ...]
    flag: str
    digests: tuple[str, ...]
    fingerprint: str
    answer: Answer
    options: tuple[Any, ...]

    @property
    def parts(self) -> int:
        """Number of inputs."""
        return len(self.inputs)

    @property
    def about(self) -> str:
        """For the progress bar."""
        return f"{len(self.inputs)} {self.noun}"

    @property
    def folders(self) -> list[str]:
        """One an input: where its results go, below the directory of --out."""
        return short_names(self.inputs)

    def key(self, number: int) -> str:
        """Name of an input's part."""
        return f"{number:06d}-{self.digests[number]}"

    def call(self, number: int) -> tuple[Callable[..., Outcome], tuple[Any, ...]]:
        """What answers one input."""
        return outcome, (self.answer, self.inputs[number], *self.options)


def answer_all(work: ManyInputs, where: Where, output: Output, row: Callable[[Mapping[str, Any]], Row]) -> list[Row]:
    """Answer all inputs; with --out, each input's files are written as it is done. One row an input, in their order.

    row : of an input's result.json, what the table shows
    """
    folders = work.folders

    def kept(number: int, found: Outcome) -> dict[str, np.ndarray]:
        given = work.inputs[number]
        told = {"input": given, "folder": folders[number], "exit_code": found.code, "message": found.message}
        if found.code == 0:
            one = output.of_input(folders[number], _alone(output.words, work.typed, given, work.flag))
            one.write(found.result, found.files)
            told |= row(found.result)
        return {"row": np.array([json.dumps(plain(told))])}

    found, _ = run_work(work, where, output, kept)
    return [json.loads(str(found[number]["row"][0])) for number in range(work.parts)]


def worst_code(rows: Sequence[Row]) -> int:
    """2 where an input cannot be used, 1 where one cannot be answered, else 0."""
    return max(row["exit_code"] for row in rows)


def require_different(inputs: Sequence[str], name: str) -> None:
    """Refuse an input that is given twice.

    Raises
    ------
    InputError : names the first such input.
    """
    for number, given in enumerate(inputs):
        if given in inputs[:number]:
            raise InputError(name, "", given, "each once; it is given twice")


def short_names(inputs: Sequence[str]) -> list[str]:
    """Different names of folders, short and telling: what differs between the paths, without the suffix."""
    words = [Path(given).with_suffix("").parts for given in inputs]
    if len({w[-1] for w in words}) == 1:
        words = [w[:-1] or w for w in words]
    names = [_safe(w[-1]) for w in words]
    if not _all_differ(names):
        names = [_safe("-".join(w[-2:])) for w in words]
    if not _all_differ(names):
        names = [f"{number:04d}-{name}" for number, name in enumerate(names, start=1)]
    return names


def _all_differ(names: Sequence[str]) -> bool:
    """Whether they name different files on every system: some take A for a, and both codings of an umlaut as one."""
    return len({unicodedata.normalize("NFC", name).casefold() for name in names}) == len(names)


def _safe(name: str) -> str:
    kept = "".join(c if c.isalnum() or c in "-_." else "_" for c in name).strip("._")
    return kept[:100] or "input"


def _alone(words: Sequence[str], typed: Sequence[str], given: str, flag: str) -> tuple[str, ...]:
    """The command for one of the inputs, from that for all; `typed` are the inputs as they were typed."""
    own = [flag, given] if flag else [given]
    kept, left = list[str](), list(words)
    while left:
        word = left.pop(0)
        if word == "--workers":
            left.pop(0)
        elif word in typed or word.removeprefix(f"{flag}=") in typed:
            if flag and kept[-1] == flag:
                kept.pop()
            kept, own = kept + own, []
        elif not word.startswith("--workers="):
            kept.append(word)
    return tuple(kept)
