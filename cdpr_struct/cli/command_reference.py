"""The command-line reference, docs/commands.md, written from the commands themselves.

python -m cdpr_struct.cli.command_reference     writes the page
"""

import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, get_args, get_origin

from cdpr_struct.cli.command import with_output
from cdpr_struct.cli.main import COMMANDS

PAGE = Path("docs/commands.md")
SHARED = ("out", "json", "quiet", "overwrite", "tables")
VALUES = {int: "INTEGER", float: "NUMBER", str: "TEXT", Path: "PATH"}
MORE = {
    "robots": ("files.md", "robot file"),
    "cable": ("limits.md", "limits of the closed form"),
    "inverse": ("statics.md", "statics"),
    "forward": ("statics.md", "statics"),
    "pose-error": ("statics.md", "statics"),
    "map": ("scale_out.md", "large maps"),
    "modes": ("dynamics.md", "dynamics"),
    "verify": ("tutorial_model_right.md", "tutorial: is my model right?"),
    "reproduce": ("thesis.md", "findings"),
    "new-robot": ("templates.md", "robot files to begin with"),
    "new-campaign": ("templates.md", "campaigns to begin with"),
    "rerun": ("templates.md", "the same run again"),
    "export": ("formats.md", "formats"),
    "import-caspr": ("first_day.md", "a first day"),
    "derive": ("formulas/catenary.md", "formulas"),
    "distribute": ("tutorial_trajectory.md", "tutorial: forces along a trajectory"),
    "frf": ("damping.md", "damping and responses"),
    "transient": ("damping.md", "damping and responses"),
    "spectrogram": ("recordings.md", "how to use recordings"),
    "audit": ("limits.md", "limits of the closed form"),
    "ambient": ("ambient_records.md", "ambient records"),
    "diagnose": ("measuring.md", "how to measure and read a verdict"),
    "view": ("live_view.md", "how to watch a robot live"),
    "plan": ("measuring.md", "how to measure and read a verdict"),
}
HEAD = """# Command-line reference

`cdpr-struct COMMAND [OPTIONS]`; `cdpr-struct COMMAND -h` shows the same text. A value that begins with a minus sign is
attached with `=`, as in `--pose=-1,0,0.5`. Keys of `result.json` and all file formats: [files](files.md).

| exit code | meaning |
|---|---|
| 0 | done |
| 1 | done, and what was checked does not hold; or the robot cannot do it |
| 2 | unusable input; one line names field, value, and what would be right |
| 130 | interrupted; [finished parts](scale_out.md) are kept where the command keeps any |
"""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument or option: how it is typed, what it means, and its default as shown ("" if there is none)."""

    key: str
    typed: str
    meaning: str
    default: str
    argument: bool
    required: bool


def parameters(run: Callable[..., int]) -> Iterator[Parameter]:
    """Arguments and options of a command, in the order of its help."""
    for given in inspect.signature(run, eval_str=True).parameters.values():
        if get_origin(given.annotation) is Annotated:
            kind, info = get_args(given.annotation)
            yield _parameter(given, kind, info)


def _parameter(given: inspect.Parameter, kind: Any, info: Any) -> Parameter:
    bare = next((part for part in get_args(kind) if part is not type(None)), kind)
    names = [text for text in (info.default, *(info.param_decls or ())) if isinstance(text, str)]
    value = info.metavar or VALUES.get(bare, "")
    argument, required = not names, given.default is inspect.Parameter.empty
    typed = value if argument else ", ".join(names) + (f" {value}" if value else "")
    return Parameter(given.name, typed, info.help or "", _default(given.default), argument, required)


def _default(value: object) -> str:
    if value is inspect.Parameter.empty or value is None or value is False:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value)


def reference() -> str:
    """The whole page."""
    described = [(command.NAME, _first_line(command)) for command in COMMANDS]
    table = [f"| [{name}](#{name}) | {text} |" for name, text in described]
    shared = [one for one in parameters(with_output(COMMANDS[0].run)) if one.key in SHARED]
    lines = [HEAD, "| command | does |", "|---|---|", *table, "", "## Options of every command", "", *_rows(shared), ""]
    for command in COMMANDS:
        lines += _section(command)
    return "\n".join([*lines, "Generated from the commands: `python -m cdpr_struct.cli.command_reference`.", ""])


def _first_line(command: ModuleType) -> str:
    return " ".join((inspect.getdoc(command.run) or "").split("\n\n")[0].split())


def _section(command: ModuleType) -> list[str]:
    own = list(parameters(command.run))
    usage = " ".join(["cdpr-struct", command.NAME, *(p.typed for p in own if p.argument), "[OPTIONS]"])
    page, title = MORE.get(command.NAME, ("", ""))
    more = [f"More: [{title}]({page}).", ""] if command.NAME in MORE else []
    table = [*_rows(own), ""] if own else []
    return [
        f"## {command.NAME}", "", f"{_first_line(command)}", "", "```text", usage, "```", "", *table,
        "```sh", *command.EXAMPLES, "```", "", *more,
    ]  # fmt: skip


def _rows(own: list[Parameter]) -> list[str]:
    rows = [f"| {_code(p.typed)} | {_cell(p)} | {_code(p.default)} |" for p in own]
    return ["| argument or option | meaning | default |", "|---|---|---|", *rows]


def _code(text: str) -> str:
    return f"`{text.replace('|', '&#124;')}`" if text else ""


def _cell(parameter: Parameter) -> str:
    meaning = parameter.meaning.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")
    return f"{meaning} Required." if parameter.required and not parameter.argument else meaning


if __name__ == "__main__":
    PAGE.write_text(reference(), encoding="utf-8")
