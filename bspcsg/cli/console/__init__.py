"""The terminal: streams, tables, colours, and the status line."""
