"""Inputs of verbs: files, streams and scripts."""
