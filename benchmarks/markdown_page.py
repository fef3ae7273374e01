"""Tables in Markdown, and pages of which a program rewrites the tables only."""


def table(head: list[str], rows: list[list[str]]) -> str:
    """Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def put(page: str, name: str, text: str) -> str:
    """The page with what stands between `<!-- name -->` and the next `<!-- end -->` replaced."""
    before, mark, rest = page.partition(f"<!-- {name} -->")
    if not mark:
        raise ValueError(f"the page has no <!-- {name} -->")
    return f"{before}{mark}\n{text}\n<!-- end -->{rest.partition('<!-- end -->')[2]}"
