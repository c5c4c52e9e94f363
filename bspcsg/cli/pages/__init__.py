"""Pages that verbs write or serve."""
