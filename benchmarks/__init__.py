"""Benchmarks: one question a file, peers side by side, one command for all (`python -m benchmarks`).

One thread: the numerical libraries read these variables when they are loaded.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
