"""A scene of surfaces, from its text to tool paths, as they are shown, plotted and listed."""
