"""Rest machining: what the operations before have left."""
