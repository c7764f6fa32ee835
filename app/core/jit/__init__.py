"""Compiled inner loops: one decorator, compiled when they are first called, kept in the user's cache folder."""

from .compiled import Compiled, Kernel, kernel

__all__ = ["Compiled", "Kernel", "kernel"]
