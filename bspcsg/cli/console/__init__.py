"""What the terminal shows: streams, tables, colours, and the line that says what is under way."""
