"""The Surfaces view: a scene's compound surface, the paths over it, and its sections."""
