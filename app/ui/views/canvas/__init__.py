"""The drawing canvas: shows part and tool paths, and turns mouse and keys into lines of the drawing language."""
