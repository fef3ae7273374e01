"""`cdpr-struct robots`: the robots that come with the package."""

from cdpr_struct.cli.options import Json, Out
from cdpr_struct.cli.output import emit, result_json, write_files

NAME = "robots"


def run(out: Out = None, json: Json = False) -> int:
    """List the built-in robots."""
    from cdpr_struct.robot.robot_file import builtin_names, load_robot

    found = [load_robot(name) for name in builtin_names()]
    rows = [{"name": r.name, "cables": len(r.cables), "description": r.description} for r in found]
    result = {"robots": rows}

    def text() -> None:
        for row in rows:
            print(f"{row['name']:<16} {row['cables']} cables  {row['description']}")

    emit(result, json, text)
    if out is not None:
        write_files(out, {"result.json": result_json(result)})
    return 0
