"""Campaigns: thousands of set operations, each checked against other engines and recorded."""
