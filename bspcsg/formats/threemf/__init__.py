"""Reading and writing 3MF packages."""
