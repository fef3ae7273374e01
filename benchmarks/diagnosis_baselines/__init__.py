"""What is the diagnosis worth? Textbook selections of causes, and the diagnosis with parts taken out, on blind cases.

material  : what every method gets;  parameter_methods, stepwise_bic, evidence_methods : material to names of causes
answering : campaigns to answers;  scores : answers and truth to tables;  page : tables to docs/diagnosis_baselines.md
"""
