"""Ten thousand random robots and poses: does every answer stand up to mechanics that are written down a second time?

python -m benchmarks random-robots [--seeds A:B[:N]] [--workers N] --out DIR
"""
