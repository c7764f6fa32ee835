"""Which tools a drawing asks for."""
