"""Triangles as files hold them, and which side of a surface of triangles is out."""
