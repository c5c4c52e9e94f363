"""Rays: exact hits, and trees that learn from what is asked."""
