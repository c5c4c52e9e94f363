"""Benchmarks against other engines: cases, engines, time and memory, records, tables and plots."""
