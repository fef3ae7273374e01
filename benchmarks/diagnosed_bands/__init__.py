"""Do bands of robots that a diagnosis has extended hold as many truths as they say, at poses that nobody measured?

python -m benchmarks diagnosed-bands [--sets DIR ..] [--workers N] --out DIR
"""
