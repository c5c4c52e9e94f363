"""The terminal: its streams, tables and colours, and the line that says what is under way."""
