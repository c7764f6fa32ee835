"""A program of one control in the words of another: block by block, and proven by reading both."""
