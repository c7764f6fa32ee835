"""What helps to find one's way: the manual's window, keys, the tour, what is this."""
