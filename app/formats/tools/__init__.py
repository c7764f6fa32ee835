"""Tool libraries, tool tables, holders."""
