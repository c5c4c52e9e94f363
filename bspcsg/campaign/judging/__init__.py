"""What a case comes to: its evaluation, opinions on it, and the ruling."""
