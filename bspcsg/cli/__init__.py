"""The command line: set operations, checks and conversions of mesh files, with exit codes."""
