"""DXF in and out."""
