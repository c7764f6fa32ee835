"""From a drawing to an NC program that was written, read back, cut and judged."""
