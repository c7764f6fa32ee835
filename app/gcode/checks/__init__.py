"""The written text read back: is it the moves that were meant?"""
