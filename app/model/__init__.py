"""The language that all rooms share: what the user owns, as frozen values."""
