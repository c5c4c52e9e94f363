"""The Stanford polygon format."""
