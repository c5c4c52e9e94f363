"""Pages that verbs write, and pages that a live server shows."""
