"""The cases that a campaign examines, their sources, and their poses."""
