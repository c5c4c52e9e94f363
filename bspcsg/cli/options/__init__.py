"""Options, arguments and formulas, and their parsing."""
