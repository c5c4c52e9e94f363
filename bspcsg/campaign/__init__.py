"""Campaigns: thousands of set operations, each checked against other engines and kept on file."""
