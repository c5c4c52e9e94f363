"""HTML pages that verbs of the command line write or serve."""
