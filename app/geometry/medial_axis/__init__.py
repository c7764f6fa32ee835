"""The medial axis of regions: every centre of a disc that touches their boundary in two places."""
