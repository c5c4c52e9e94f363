"""Output on a terminal or in a pipe: streams, tables, colours, and the status line."""
