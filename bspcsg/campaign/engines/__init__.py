"""Other engines that carry out a campaign's operations for comparison."""
