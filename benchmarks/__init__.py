"""Benchmarks: how good, how fast; the answers are checked as well."""
