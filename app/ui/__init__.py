"""The window. Shows state, emits intent; computes nothing itself."""
