"""The checks of a result: other engines' answers, and exact rulings between them."""
