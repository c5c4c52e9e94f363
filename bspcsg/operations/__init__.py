"""What is made of several solids, or of the parts of one."""
