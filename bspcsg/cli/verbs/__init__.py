"""The verbs of the command line, such as `union` and `check`, one or more in each module."""
