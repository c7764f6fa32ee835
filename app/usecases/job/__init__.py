"""A job put together from a drawing, its own job, and what the user asked for."""
