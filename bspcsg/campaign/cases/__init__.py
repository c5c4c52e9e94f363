"""The cases of a campaign: where they come from, their operands and their poses."""
