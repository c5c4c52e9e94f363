"""The judging of a case: its evaluation, opinions on it, and the ruling."""
