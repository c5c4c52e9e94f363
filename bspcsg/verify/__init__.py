"""Checks of results against other engines, and exact counts that settle disagreements."""
