"""Points become splines within a proven tube; effective points (2006, 2014)."""
