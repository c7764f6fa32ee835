"""Pictures and sheets of paper."""
