"""The command line: the same operations on files, with exit codes that scripts can trust."""
