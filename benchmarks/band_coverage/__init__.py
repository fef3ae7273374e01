"""Do bands of predictions hold as many robots as they say? Robots off by their tolerances, solved by finite elements.

python -m benchmarks band-coverage [--seeds A:B[:N]] [--workers N] --out DIR
"""
