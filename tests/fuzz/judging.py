"""What every reader owes: an answer or a sentence of the program's own, of limited length, within seconds."""

import hashlib
import json
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from cdpr_struct.errors import told

LONGEST = 2000  # characters of a sentence, the name of the file and what would be right included
_REMEMBERED = 300  # inputs that were loaded, as a start for others
SLOWEST = 5.0  # s of processor time for one input

Reader = Callable[[bytes], None]


class Judge:
    """Hands inputs to a reader, counts what came of them, and keeps one input of each kind of finding."""

    def __init__(self, reader: Reader, directory: Path) -> None:
        self.reader, self.directory = reader, directory
        self.outcomes: Counter[str] = Counter()
        self.findings: dict[str, str] = {}
        self.loaded: list[bytes] = []
        self.slowest = 0.0
        self.started = time.process_time()
        directory.mkdir(parents=True, exist_ok=True)

    def __call__(self, data: bytes) -> None:
        begun = time.process_time()
        outcome, why = judged(self.reader, data)
        taken = time.process_time() - begun
        if taken > self.slowest:
            self.slowest = taken
        if taken > SLOWEST:
            outcome, why = "finding", f"slow: {taken:.0f} s; {why}"
            self._keep("slow", why, data)
        elif why:
            self._keep(why.partition("\n")[0][:200], why, data)
        self.outcomes[outcome] += 1
        if outcome == "loaded":
            self.loaded = [data, *self.loaded[: _REMEMBERED - 1]]

    def seconds(self) -> float:
        """Processor time since the start."""
        return time.process_time() - self.started

    def summary(self) -> str:
        """Counts as JSON."""
        counts = {"executions": sum(self.outcomes.values()), **self.outcomes}
        rest = {"seconds": round(self.seconds(), 1), "slowest": round(self.slowest, 2), "findings": list(self.findings)}
        return json.dumps({**counts, **rest}, indent=1)

    def _keep(self, kind: str, why: str, data: bytes) -> None:
        if kind in self.findings:
            return
        self.findings[kind] = why
        name = hashlib.sha256(kind.encode()).hexdigest()[:12]
        (self.directory / f"{name}.input").write_bytes(data)
        (self.directory / f"{name}.txt").write_text(why, "utf-8", "backslashreplace")


def judged(reader: Reader, data: bytes) -> tuple[str, str]:
    """`loaded`, `refused` or `finding`, and what is wrong: its kind in the first line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            reader(data)
    except (Exception, RecursionError) as error:
        known = told(error)
        if known is not None:
            fault = sentence_fault(str(known))
            return ("finding", f"{fault} {_origin(error)}\n{known}") if fault else ("refused", "")
        trace = "".join(traceback.format_exception(error))
        return "finding", f"{type(error).__name__} {_origin(error)}\n{trace[-4000:]}"
    return "loaded", ""


def sentence_fault(sentence: str) -> str:
    """What is wrong with a complaint as a single printable line; "" if nothing is."""
    if len(sentence) > LONGEST:
        return f"a sentence of more than {LONGEST} characters"
    if not sentence.isprintable():
        return "a sentence with characters that cannot be printed"
    return ""


def _origin(error: BaseException) -> str:
    """File and line of the package that the error was last seen in."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if "cdpr_struct" in f.filename]
    return f"at {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "at an unknown place"
