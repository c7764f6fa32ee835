"""The right side of the window: job, tools, operations, and the properties of what is selected."""
