"""The shape language: a drawing in words, a command a line."""
