"""How low a cutter comes over facets and over what they stand for."""
