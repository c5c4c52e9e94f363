"""Timed comparisons with other engines: cases, engines, measuring, records, tables and plots."""
