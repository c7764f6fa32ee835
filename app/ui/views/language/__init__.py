"""The shape language in the window: an editor with live preview, and help on its words."""
