"""Are sizes of causes as uncertain as a diagnosis says? Ranks of true sizes in the posterior, truth by finite elements.

python -m benchmarks posterior-ranks [--seeds A:B[:N]] [--workers N] --out DIR
"""
