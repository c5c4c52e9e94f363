"""Checks of results: other engines' answers, and exact rulings between them."""
