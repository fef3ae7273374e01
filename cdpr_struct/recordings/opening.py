"""Opens a recording with the reader of its form."""

from collections.abc import Callable
from pathlib import Path

from cdpr_struct.recordings.channel import Clock, Recording
from cdpr_struct.recordings.form import Form, form_of
from cdpr_struct.recordings.matlab import open_mat
from cdpr_struct.recordings.matlab_hdf import open_mat_hdf
from cdpr_struct.recordings.mdf import open_mdf
from cdpr_struct.recordings.ros_bag import open_bag
from cdpr_struct.recordings.tdms import open_tdms
from cdpr_struct.recordings.text_table import open_text
from cdpr_struct.recordings.universal import open_universal
from cdpr_struct.recordings.workbook import open_workbook

_BAGS: tuple[Form, ...] = ("bag", "ros2", "mcap", "db3")
_READERS: dict[Form, Callable[[Path], Recording]] = {
    "tdms": open_tdms, "mdf": open_mdf, "mat": open_mat, "mat73": open_mat_hdf, "xlsx": open_workbook,
    "uff": open_universal, "text": open_text,
}  # fmt: skip


def open_recording(path: Path, clock: Clock = "stamp") -> Recording:
    """The recording of a file, or of the folder of a ROS 2 bag, told by its content.

    clock : of bags: `stamp`, the times of the messages' headers where they have one, or `received`

    Raises
    ------
    InputError : no such file, an unknown or damaged one, or a package to read it is not installed.
    """
    form = form_of(path)
    return open_bag(path, form, clock) if form in _BAGS else _READERS[form](path)
