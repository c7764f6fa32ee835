"""What is wrong with a block, as the stages find it: without its place, which only the reader knows."""

from __future__ import annotations


class BlockFault(Exception):
    """A block cannot be carried out.

    Attributes:
        text: a sentence: what is wrong, what was expected.
        letter: the word that it is about, such as "R"; "" = the block. The reader finds the word by it.
        column: 1-based, where the stage knows it; 0 = not known.
        word: the word as written, where the stage knows it.
    """

    def __init__(self, text: str, letter: str = "", column: int = 0, word: str = "") -> None:
        super().__init__(text)
        self.text, self.letter, self.column, self.word = text, letter, column, word
