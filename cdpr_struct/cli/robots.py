"""`cdpr-struct robots`: the robots that come with the package."""

from cdpr_struct.cli.output import Files, Output

NAME = "robots"
EXAMPLES = ("cdpr-struct robots", "cdpr-struct robots --out results/robots")


def run(*, output: Output) -> int:
    """List the built-in robots."""
    from cdpr_struct.robot.robot_file import builtin_names, load_robot

    found = [load_robot(name) for name in builtin_names()]
    rows = [{"name": r.name, "cables": len(r.cables), "description": r.description} for r in found]
    result = {"robots": rows}

    def files() -> Files:
        from cdpr_struct.reports.robots_page import robots_files

        return robots_files(found, rows)

    lines = (f"{row['name']:<16} {row['cables']} cables  {row['description']}" for row in rows)
    output.deliver(result, lambda: "\n".join(lines), files)
    return 0
