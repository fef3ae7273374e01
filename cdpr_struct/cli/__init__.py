"""Command line: files and screens around the numerics."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")  # matrices here are small: threads for each would wait for each other
