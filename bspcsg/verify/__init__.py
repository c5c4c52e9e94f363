"""Whether a result is right: other engines' answers, and exact rulings between them."""
