"""Writes the list of public names into docs/python.md and into the docstring of `cdpr_struct`, from the code.

Run: python -m tests.interface.reference
"""

import inspect
import math
import re
import textwrap
from pathlib import Path

import cdpr_struct as cs

ROOT = Path(__file__).parents[2]
PAGE, SOURCE = ROOT / "docs" / "python.md", ROOT / "cdpr_struct" / "__init__.py"
_BEGIN, _END = "<!-- generated: python -m tests.interface.reference -->\n", "<!-- end of what is generated -->\n"
_GROUPS = {
    "Robots": ("robot.", "interface.robots", "interface.new_robot", "interface.export"),
    "Measured data": (
        "measurement.",
        "interface.diagnose",
        "interface.plan",
        "interface.campaigns",
        "interface.new_campaign",
        "interface.import_recording",
    ),
    "Errors": ("errors", "crosscheck."),
    "Values": ("workspace.", "statics.", "interface.result"),
}
_ELSE = "Predictions and checks"


def names_by_group() -> dict[str, list[str]]:
    """Public names in the order of the package, group by group."""
    groups: dict[str, list[str]] = {name: [] for name in ("Robots", _ELSE, "Measured data", "Values", "Errors")}
    for name, module in cs._HOME.items():
        home = module.removeprefix("cdpr_struct.")
        group = next((g for g, starts in _GROUPS.items() if home.startswith(starts)), _ELSE)
        groups[group].append(name)
    return groups


def documented(thing: object) -> str:
    """The first sentence of a docstring, on one line."""
    return (inspect.getdoc(thing) or "").split("\n\n")[0].replace("\n", " ")


def signature(name: str) -> str:
    """Name and arguments with their defaults; types are in the docstrings."""
    given = inspect.signature(getattr(cs, name))
    bare = [p.replace(annotation=p.empty) for p in given.parameters.values() if not p.name.startswith("_")]
    text = str(inspect.Signature(bare))
    return name + re.sub(r"<function (\w+) at \w+>", r"\1", text).replace(repr(4.0 * math.pi), "4 pi")


def entry(name: str) -> str:
    """A name's paragraphs on the page: signature, meaning, and what its result holds."""
    thing = getattr(cs, name)
    not_made_by_users = inspect.isclass(thing) and issubclass(thing, (Exception, cs.Campaign, cs.Result))
    lines = [f"`{name if not_made_by_users else signature(name)}`", "", documented(thing)]
    answer = inspect.signature(thing).return_annotation if inspect.isfunction(thing) else None
    if inspect.isclass(answer) and issubclass(answer, cs.Result):
        held = (inspect.getdoc(answer) or "").split("\n\n")[1:]
        if held:
            lines[-1] += f" `{answer.__name__}` holds:"
            lines += ["", *(f"- {line}" for part in held for line in re.split(r"\n|;  ", part))]
    return "\n".join(lines)


def page_text() -> str:
    """docs/python.md with the list made anew."""
    head, _, rest = PAGE.read_text("utf-8").partition(_BEGIN)
    _, _, tail = rest.partition(_END)
    groups = "\n\n".join(
        f"### {group}\n\n" + "\n\n".join(entry(name) for name in names) for group, names in names_by_group().items()
    )
    return f"{head}{_BEGIN}\n{groups}\n\n{_END}{tail}"


def source_text() -> str:
    """The package's source with the list in its docstring made anew."""
    lines = []
    for group, names in names_by_group().items():
        lines += ["", f"{group}:", *(_listed(name) for name in names)]
    head, _, rest = SOURCE.read_text("utf-8").partition("\nRobots:\n")
    _, _, tail = rest.partition('"""\n')
    return head + "\n".join(lines) + '\n"""\n' + tail


def _listed(name: str) -> str:
    width = max(map(len, cs._HOME))
    said = documented(getattr(cs, name))
    indent = " " * (width + 4)
    return textwrap.fill(said, 118, initial_indent=f"  {name:<{width}}  ", subsequent_indent=indent)


if __name__ == "__main__":
    for path, text in ((PAGE, page_text()), (SOURCE, source_text())):
        path.write_text(text, "utf-8")
