"""Files, streams and scripts as what a verb works on."""
