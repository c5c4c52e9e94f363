"""Other engines that answer a campaign's questions."""
