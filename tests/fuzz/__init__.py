"""Coverage-guided fuzzing of everything that reads a file: `python -m tests.fuzz --target robot --seconds 600`.

It needs the extra `fuzz` (atheris); `pytest` collects nothing here. Each finding was corrected and has a small test in
tests/robustness/test_fuzzed_files.py.

| file | answers |
|---|---|
| `__main__.py` | how is a run started, and what does it print? |
| `targets.py` | which reader is handed which bytes? |
| `judging.py` | what is a finding? |
| `mutating.py` | how is an input changed, beside what libFuzzer does to bytes? |
| `seeds.py` | with which inputs and words does a run start? |
"""
