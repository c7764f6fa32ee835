"""The field of heights that is cut, and what it is compared with."""
