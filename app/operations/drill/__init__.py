"""Drilling: circles, straight down at their centres."""
