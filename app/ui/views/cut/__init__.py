"""The Cut view: the stock as the program leaves it, in three dimensions."""
