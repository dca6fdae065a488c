"""Benchmark of motion cloning: pairs with known truth, a judge, baselines, a table."""
