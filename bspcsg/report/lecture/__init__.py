"""The lecture on partition trees as a page."""
