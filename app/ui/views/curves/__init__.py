"""The Curves view: an NC program's moves beside the proven curves in their stead."""
