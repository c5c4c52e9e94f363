"""Rays: exact hits, and trees that adapt to the queries."""
