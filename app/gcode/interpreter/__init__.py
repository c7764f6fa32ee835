"""The NC reader, an RS274/NGC interpreter in stages: text, words, blocks, modal state, motions."""
