"""What the canvas paints: paper, drawing, tool paths, annotations, and what follows the mouse."""
