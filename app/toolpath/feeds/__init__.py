"""Feeds and speeds: what material, tool and machine allow, each number with its reason."""
