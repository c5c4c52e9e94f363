"""Pictures painted from back to front."""
