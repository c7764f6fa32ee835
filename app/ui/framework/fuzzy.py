"""How well a few typed letters fit a text. No Qt."""

from __future__ import annotations

_START, _RUN, _WHOLE = 8.0, 5.0, 20.0


def fit(typed: str, text: str, beside: str = "") -> float | None:
    """Return how well `typed` fits a text: the letters come in this order; starts of words, runs and short texts count
    more.

    Blanks part words each of which must fit, or stand whole in what is written beside the text. None = it does not fit;
    0 for nothing typed.
    """
    total = 0.0
    for word in typed.lower().split():
        found = _word(word, text.lower())
        if found is None and word in beside.lower():
            found = 0.0
        if found is None:
            return None
        total += found
    return total - len(text) / 100 if typed.strip() else 0.0


def _word(word: str, text: str) -> float | None:
    at = text.find(word)
    if at >= 0:
        return _WHOLE + len(word) + (_START if _starts(text, at) else 0.0)
    score, at, before = 0.0, 0, -2
    for letter in word:
        starts = [k for k in range(at, len(text)) if text[k] == letter and _starts(text, k)]
        here = text.find(letter, at)
        if here < 0:
            return None
        if here != before + 1 and starts:
            here = starts[0]
        score += _START if _starts(text, here) else _RUN if here == before + 1 else 0.0
        before, at = here, here + 1
    return score


def _starts(text: str, at: int) -> bool:
    return at == 0 or not text[at - 1].isalnum()
