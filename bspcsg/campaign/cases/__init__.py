"""What a campaign examines: cases, where they are from, and in which pose."""
