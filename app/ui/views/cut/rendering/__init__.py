"""The scene of the Cut view on the graphics side: stock, paths, tool, facets. No Qt."""
