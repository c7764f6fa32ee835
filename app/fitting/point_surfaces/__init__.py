"""Points of passes over a surface: where its facets meet, and a smooth surface through those places."""
