"""What the Stages view paints: pixels, and the key of their codes."""
