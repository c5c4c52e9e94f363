"""Options, arguments and formulas as they are typed."""
