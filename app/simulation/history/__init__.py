"""Every state of a work piece on its way."""
