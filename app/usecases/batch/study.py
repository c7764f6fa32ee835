"""One file many ways: every combination of some options' values, and which of them takes least time.

"Which tool?" is such a study, of a pocket tool and a contour tool each; so are tolerances against time.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import product
from urllib.parse import quote

from ...core.errors import InputError
from ...core.options import option
from ...core.wording import minutes_words
from ...toolpath.advice.advise import Advice
from .table import Files, PageTable, findings_html, harmless, listed, page_of
from .task import BatchRow, BatchVerdict

MOST_CHOICES = 2000
"""Of a study: what takes a second each is an hour's work on one core."""

_NARROW = "\u202f"
"""Space between thousands."""
_SAME_MM2 = 0.01
"""What is left is alike within this."""
_WIDTH, _HEIGHT, _EDGE = 480, 180, 36
"""Of the plot, px, and what its numbers take of that."""
_UNSAFE = re.compile(r"[^A-Za-z0-9.+-]+")


@dataclass(frozen=True)
class StudyAxis:
    """An option that is varied.

    Attributes:
        option: without its dashes. values: as they are typed; one at least, none twice.
    """

    option: str
    values: tuple[str, ...]

    def __post_init__(self) -> None:
        if not self.values or not all(self.values):
            written = option("vary", f"{self.option}=V1,V2,…")
            raise InputError(f"{option('vary', self.option)}: a value is missing; write {written}")
        if len(set(self.values)) < len(self.values):
            raise InputError(f"{option('vary', self.option)}: a value is there twice; write each once")


@dataclass(frozen=True)
class StudyChoice:
    """One combination.

    Attributes:
        values: one of each axis, in their order.
    """

    axes: tuple[StudyAxis, ...]
    values: tuple[str, ...]

    @property
    def name(self) -> str:
        """What people are told that it is."""
        return " ".join(f"{axis.option}={value}" for axis, value in zip(self.axes, self.values, strict=True))

    @property
    def stem(self) -> str:
        """Name of its files, without what a file system does not take."""
        return _UNSAFE.sub("_", self.name)

    @property
    def options(self) -> tuple[str, ...]:
        """It as it is typed behind a command."""
        return tuple(f"--{axis.option}={value}" for axis, value in zip(self.axes, self.values, strict=True))


def choices_of(axes: Sequence[StudyAxis]) -> tuple[StudyChoice, ...]:
    """Return all combinations, the last option's values changing first.

    Raises:
        InputError: there is no axis, an option is there twice, or there are too many combinations.
    """
    names = [axis.option for axis in axes]
    if not names:
        written = option("vary", "OPTION=V1,V2,…")
        raise InputError(f"Nothing is varied; say {written}, or {option('which-tool')}.")
    if len(set(names)) < len(names):
        twice = option("vary", max(names, key=names.count))
        raise InputError(f"{twice} is there twice; write all its values in one.")
    found = tuple(StudyChoice(tuple(axes), values) for values in product(*(axis.values for axis in axes)))
    if len(found) > MOST_CHOICES:
        raise InputError(f"That makes {len(found)} combinations; {MOST_CHOICES} are the most, so vary less.")
    return found


def tool_choices(advice: Advice, others: Sequence[StudyAxis] = ()) -> tuple[StudyChoice, ...]:
    """Return the pairs of tools that are worth a try: both fit somewhere, and the one that clears is no thinner.

    Args:
        advice: on the drawing, about the tools to choose from. others: options that are varied beside.

    Raises:
        InputError: no tool fits, or there are too many combinations.
    """
    fitting = [f"{each.tool.diameter:g}" for each in advice.choices if each.share > 0]
    if not fitting:
        raise InputError(f"There is nothing to choose: {advice.why}")
    sizes = tuple(dict.fromkeys(fitting))
    pocket, contour = StudyAxis("pocket-tool", sizes), StudyAxis("contour-tool", sizes)
    return tuple(
        each for each in choices_of((pocket, contour, *others)) if float(each.values[0]) >= float(each.values[1])
    )


def ranked(rows: Sequence[BatchRow]) -> list[int]:
    """Return the places of the rows that have a program, first those without findings, each by time."""
    timed = [(row.verdict is not BatchVerdict.CLEAN, row.time_s, at) for at, row in enumerate(rows) if row.time_s]
    return [at for _, _, at in sorted(timed)]


@dataclass(frozen=True)
class _Number:
    """A number of the table.

    Attributes:
        column: of the table for spreadsheets. head, unit: of the page. of: takes it from a row. digits: of decimals.
    """

    column: str
    head: str
    unit: str
    of: Callable[[BatchRow], float | None]
    digits: int

    def in_csv(self, row: BatchRow) -> str:
        """Return it as spreadsheets read it; "" = none."""
        value = self.of(row)
        return "" if value is None else f"{value:.{self.digits}f}"

    def in_html(self, row: BatchRow) -> str:
        """Return its cell."""
        value = self.of(row)
        words = "" if value is None else minutes_words(value) if self.unit == "min" else f"{value:,.0f}"
        return f'<td class="number" data-unit="{self.unit}">{words.replace(",", _NARROW)}</td>'


_NUMBERS = (
    _Number("time_s", "Time, min", "min", lambda row: row.time_s, 1),
    _Number("length_mm", "Length, mm", "mm", lambda row: row.length_mm, 3),
    _Number("left_mm2", "Left, mm²", "mm²", lambda row: row.left_mm2, 3),
)
_TOLD = ("findings_that_count", "findings", "outputs")


def study_csv(choices: Sequence[StudyChoice], rows: Sequence[BatchRow], files: Files) -> bytes:
    """Return the table for spreadsheets, in UTF-8: a column an option, a row a combination, in their order."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    head = [axis.option for axis in choices[0].axes]
    writer.writerow([*head, "verdict", *(number.column for number in _NUMBERS), *_TOLD])
    for choice, row, written in zip(choices, rows, files, strict=True):
        numbers = [number.in_csv(row) for number in _NUMBERS]
        told = (row.verdict.value, *numbers, row.counting, " | ".join(row.findings), listed(written))
        writer.writerow([harmless(str(cell)) for cell in (*choice.values, *told)])
    return text.getvalue().encode("utf-8", "backslashreplace")


def study_html(choices: Sequence[StudyChoice], rows: Sequence[BatchRow], files: Files, title: str) -> bytes:
    """Return the table as one page, the shortest first, with a plot where one number is varied."""
    order = ranked(rows)
    order += [at for at in range(len(rows)) if at not in set(order)]
    head = "".join(f"<th data-number>{escape(axis.option)}</th>" for axis in choices[0].axes)
    shown = [number for number in _NUMBERS if any(number.of(row) is not None for row in rows)]
    numbers = "".join(f"<th data-number>{number.head}</th>" for number in shown)
    body = "\n".join(_choice_row(choices[at], rows[at], shown, files[at]) for at in order)
    heads = f"<th></th>{head}<th>Verdict</th>{numbers}<th>Findings</th>"
    return page_of(
        title, rows, f"{best_words(choices, rows)}{_plot(choices, rows)}", PageTable("combination", heads, body)
    )


def best_words(choices: Sequence[StudyChoice], rows: Sequence[BatchRow]) -> str:
    """Return which combination takes least time, and which of those that leave least; "" where there is no program."""
    order = ranked(rows)
    if not order:
        return ""
    least = min((rows[at].left_mm2 or 0.0 for at in order if rows[at].verdict is BatchVerdict.CLEAN), default=0.0)
    thorough = [at for at in order if (rows[at].left_mm2 or 0.0) <= least + _SAME_MM2]
    best, second = order[0], thorough[0] if thorough else order[0]
    said = f"Least time: {_best(choices[best], rows[best])}."
    return said if best == second else f"{said} Least left: {_best(choices[second], rows[second])}."


def _best(choice: StudyChoice, row: BatchRow) -> str:
    left = "" if row.left_mm2 is None else f", {row.left_mm2:.2f} mm2 left"
    found = "" if row.verdict is BatchVerdict.CLEAN else ", with findings"
    return f"{choice.name}, {minutes_words(row.time_s or 0.0)} min{left}{found}"


def _choice_row(choice: StudyChoice, row: BatchRow, numbers: Sequence[_Number], files: Sequence[str]) -> str:
    cells = "".join(f'<td class="number">{escape(value)}</td>' for value in choice.values)
    links = " ".join(f'<a href="{quote(file)}">{escape(file)}</a>' for file in files)
    found = findings_html(row)
    if row.findings and not row.counting:
        found = f"<details><summary>{len(row.findings)} remarks</summary>{found}</details>"
    return (
        f'<tr data-verdict="{row.verdict.value}"><td class="picture">{row.picture}</td>{cells}'
        f'<td class="verdict"><span class="badge {row.verdict.value}">{row.verdict.words}</span></td>'
        f"{''.join(number.in_html(row) for number in numbers)}"
        f'<td class="told">{found}<span class="name">{links}</span></td></tr>'
    )


@dataclass(frozen=True)
class _Dot:
    """A combination in the plot: its value, its time, s, and whether it is clean."""

    value: float
    time_s: float
    clean: bool


def _dots(choices: Sequence[StudyChoice], rows: Sequence[BatchRow], unit: str) -> Iterator[_Dot]:
    for choice, row in zip(choices, rows, strict=True):
        if row.time_s is not None:
            yield _Dot(float(choice.values[0].removesuffix(unit)), row.time_s, row.verdict is BatchVerdict.CLEAN)


def _plot(choices: Sequence[StudyChoice], rows: Sequence[BatchRow]) -> str:
    """Return time against the one number that is varied, as SVG; "" where it is not one number."""
    one = len(choices[0].axes) == 1
    unit = "%" if all(choice.values[0].endswith("%") for choice in choices) else ""
    try:
        dots = sorted(_dots(choices, rows, unit), key=lambda dot: dot.value) if one else []
    except ValueError:
        dots = []
    if len(dots) < 2 or dots[0].value == dots[-1].value:
        return ""
    low, high, most = dots[0].value, dots[-1].value, max(dot.time_s for dot in dots)

    def place(dot: _Dot) -> tuple[float, float]:
        across = (dot.value - low) / (high - low)
        return _EDGE + across * (_WIDTH - 2 * _EDGE), _HEIGHT - _EDGE - dot.time_s / most * (_HEIGHT - 2 * _EDGE)

    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(place, dots))
    marks = "".join(
        f'<circle class="{"good" if dot.clean else "warn"}" cx="{x:.1f}" cy="{y:.1f}" r="4">'
        f"<title>{dot.value:g}{unit}: {minutes_words(dot.time_s)} min</title></circle>"
        for dot, (x, y) in zip(dots, map(place, dots), strict=True)
    )
    bottom = _HEIGHT - _EDGE
    numbers = (
        f'<text x="{_EDGE}" y="{_HEIGHT - 14}">{low:g}{unit}</text>'
        f'<text x="{_WIDTH - _EDGE}" y="{_HEIGHT - 14}" text-anchor="end">{high:g}{unit}</text>'
        f'<text x="{_WIDTH / 2}" y="{_HEIGHT - 14}" text-anchor="middle">{escape(choices[0].axes[0].option)}</text>'
        f'<text x="{_EDGE}" y="20">{minutes_words(most)} min</text>'
    )
    return (
        f'<svg class="plot" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" aria-label="time against the value">'
        f'<path d="M{_EDGE},{_EDGE}V{bottom}H{_WIDTH - _EDGE}"/><polyline points="{line}"/>{marks}{numbers}</svg>'
    )
