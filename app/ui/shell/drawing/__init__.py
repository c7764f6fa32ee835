"""What serves the drawing and its job: proposals, templates, clean-up, advice, inlays, the text page."""
