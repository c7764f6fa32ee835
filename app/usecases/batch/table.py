"""What became of the parts of a batch, as a table: for spreadsheets, and as one page with pictures."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from shlex import quote as quoted
from urllib.parse import quote

from ...core.wording import minutes_words
from .task import BatchRow, BatchVerdict

Files = Sequence[Sequence[str]]
"""Paths from the table's folder of the files of each part."""

COLUMNS = ("file", "verdict", "time_s", "length_mm", "findings_that_count", "findings", "outputs")
_SHOWN = 4
"""Findings of a part that are in sight; the others unfold."""


def results_csv(rows: Sequence[BatchRow], files: Files) -> bytes:
    """Return the table for spreadsheets, in UTF-8, a row a part."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row, written in zip(rows, files, strict=True):
        time, length = (
            "" if value is None else f"{value:.{digits}f}" for value, digits in ((row.time_s, 1), (row.length_mm, 3))
        )
        told = (row.name, row.verdict.value, time, length, row.counting, " | ".join(row.findings), listed(written))
        writer.writerow([harmless(str(cell)) for cell in told])
    return text.getvalue().encode("utf-8", "backslashreplace")


def listed(files: Sequence[str]) -> str:
    """Return paths as one cell, quoted as shells do it where they must be: `shlex.split` reads it, and plain names of
    older versions, which quoted none.
    """
    return " ".join(f"'{each}'" if harmless(each) != each == quoted(each) else quoted(each) for each in files)


def harmless(cell: str) -> str:
    """Return a cell that no spreadsheet takes for a formula."""
    return f"'{cell}" if cell[:1] in ("=", "+", "@", "\t", "\r") else cell


def results_html(rows: Sequence[BatchRow], files: Files, title: str) -> bytes:
    """Return the table as one page that needs no other file, light or dark as the reader's screen is."""
    body = "\n".join(_table_row(row, written) for row, written in zip(rows, files, strict=True))
    time = sum(row.time_s or 0.0 for row in rows)
    length = sum(row.length_mm or 0.0 for row in rows) / 1000
    total = f"{minutes_words(time)} min on the machine, {length:.1f} m of motions."
    return page_of(title, rows, total, PageTable("part", _HEADS, body))


_NUMBERS = "<th data-number>Time, min</th><th data-number>Length, mm</th>"
_HEADS = f"<th></th><th>Part</th><th>Verdict</th>{_NUMBERS}<th>Findings</th>"


@dataclass(frozen=True)
class PageTable:
    """The table of a page, as HTML.

    Attributes:
        what: a row is, a word. heads: of the columns. body: the rows.
    """

    what: str
    heads: str
    body: str


def page_of(title: str, rows: Sequence[BatchRow], said: str, table: PageTable) -> bytes:
    """Return a page with a table of parts.

    Args:
        rows: that are counted. said: HTML behind their number.
    """
    counts = Counter(row.verdict for row in rows)
    tiles = "".join(
        f'<button type="button" class="tile {each.value}" data-verdict="{each.value}" aria-pressed="false">'
        f"<b>{counts[each]}</b> {each.words}</button>"
        for each in BatchVerdict
        if counts[each]
    )
    page = _PAGE.format(
        style=_STYLE,
        script=_SCRIPT,
        title=escape(title),
        parts=f"1 {table.what}" if len(rows) == 1 else f"{len(rows)} {table.what}s",
        said=said,
        tiles=tiles,
        heads=table.heads,
        body=table.body,
    )
    return page.encode("utf-8", "backslashreplace")


def _table_row(row: BatchRow, files: Sequence[str]) -> str:
    links = " ".join(f'<a href="{quote(file)}">{escape(file)}</a>' for file in files)
    time = "" if row.time_s is None else f"{minutes_words(row.time_s)}"
    length = "" if row.length_mm is None else f"{row.length_mm:,.0f}".replace(",", "\u202f")
    return (
        f'<tr data-verdict="{row.verdict.value}"><td class="picture">{row.picture}</td>'
        f'<td class="name"><b>{escape(row.name)}</b><span>{links}</span></td>'
        f'<td class="verdict"><span class="badge {row.verdict.value}">{row.verdict.words}</span></td>'
        f'<td class="number" data-unit="min">{time}</td><td class="number" data-unit="mm">{length}</td>'
        f'<td class="told">{findings_html(row)}</td></tr>'
    )


def findings_html(row: BatchRow) -> str:
    """Return the findings of a part as a list: what counts stands out, and of many the first ones are in sight."""
    items = [
        f'<li class="{"counts" if number < row.counting else "remark"}">{escape(text)}</li>'
        for number, text in enumerate(row.findings)
    ]
    if not items:
        return ""
    more = items[_SHOWN:]
    hidden = f"<details><summary>{len(more)} more</summary><ul>{''.join(more)}</ul></details>" if more else ""
    return f"<ul>{''.join(items[:_SHOWN])}</ul>{hidden}"


_PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<header><h1>{title}</h1><div class="said">{parts}. {said}</div><nav>{tiles}</nav></header>
<table>
<thead><tr>{heads}</tr></thead>
<tbody>
{body}
</tbody>
</table>
<script>{script}</script>
</body>
</html>
"""

_STYLE = """
:root { color-scheme: light dark; --paper: #fafaf8; --ink: #1e2227; --muted: #5c626a; --line: #dcdcd6; --card: #ffffff;
  --path: #009e73; --good: #0b6b4b; --good-back: #d9f2e6; --warn: #8a4b00; --warn-back: #ffe9c7; --bad: #a3182a;
  --bad-back: #fde0e2; --idle-back: #e6e6e2; }
@media (prefers-color-scheme: dark) { :root { --paper: #17191c; --ink: #e8e8e4; --muted: #a0a6ae; --line: #33373c;
  --card: #1f2226; --path: #35c79a; --good: #7fe0b8; --good-back: #143a2c; --warn: #ffc46b; --warn-back: #44300f;
  --bad: #ff9aa4; --bad-back: #4a1a20; --idle-back: #2b2f34; } }
body { margin: 2rem auto; max-width: 80rem; padding: 0 1.5rem; background: var(--paper); color: var(--ink);
  font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0; } header .said { color: var(--muted); margin: .25rem 0 1rem; }
nav { display: flex; flex-wrap: wrap; gap: .5rem; margin-bottom: 1.25rem; }
.tile { border: 1px solid transparent; border-radius: .5rem; padding: .4rem .8rem; font: inherit; cursor: pointer; }
.tile[aria-pressed=true] { border-color: currentColor; }
table { width: 100%; border-collapse: collapse; background: var(--card); }
th { text-align: left; font-weight: 600; color: var(--muted); border-bottom: 2px solid var(--line);
  padding: .4rem .6rem; }
th[data-number] { text-align: right; white-space: nowrap; }
.plot { display: block; max-width: 34rem; margin-top: .75rem; } .plot path, .plot polyline { fill: none; }
.plot path { stroke: var(--line); } .plot polyline { stroke: var(--path); stroke-width: 1.5; }
.plot text { fill: var(--muted); font-size: 12px; }
.plot .good { fill: var(--path); } .plot .warn { fill: var(--warn); }
td { border-bottom: 1px solid var(--line); padding: .5rem .6rem; vertical-align: top; }
.picture { width: 160px; } .picture svg { display: block; width: 160px; height: 110px; }
.picture path { fill: none; stroke-width: 1; stroke-linejoin: round; } .picture .path { stroke: var(--path); }
.picture .part { stroke: var(--ink); }
.name b { display: block; overflow-wrap: anywhere; }
.name a { color: var(--muted); font-size: .85rem; margin-right: .6rem; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.badge { border-radius: 1rem; padding: .15rem .65rem; white-space: nowrap; font-size: .85rem; font-weight: 600; }
.clean { color: var(--good); background: var(--good-back); }
.findings { color: var(--warn); background: var(--warn-back); }
.refused, .failed, .killed, .overdue { color: var(--bad); background: var(--bad-back); }
.open { color: var(--muted); background: var(--idle-back); }
.told { font-size: .9rem; max-width: 34rem; overflow-wrap: anywhere; } .told ul { margin: 0; padding-left: 1.1rem; }
.told .remark { color: var(--muted); } summary { color: var(--muted); cursor: pointer; }
@media (max-width: 46rem) { body { margin: 1rem auto; padding: 0 1rem; } thead { display: none; }
  tr { display: grid; grid-template-columns: auto 1fr; gap: .1rem .8rem; align-items: start; padding: .7rem;
    border-bottom: 1px solid var(--line); }
  td { border: 0; padding: 0; } td:empty { display: none; } .name, .told { grid-column: 1 / -1; }
  .verdict, .number { grid-column: 2; } .picture:empty ~ .verdict { grid-column: 1 / -1; }
  .picture { grid-row: 2 / span 3; width: 120px; } .picture svg { width: 120px; height: 83px; }
  .number { text-align: left; }
  .number:not(:empty)::after { content: " " attr(data-unit); color: var(--muted); } }
tr[hidden] { display: none; }
@media print { body { margin: 0; max-width: none; } nav { display: none; } tr { break-inside: avoid; } }
"""

_SCRIPT = """
for (const tile of document.querySelectorAll(".tile")) tile.onclick = () => {
  tile.setAttribute("aria-pressed", tile.getAttribute("aria-pressed") !== "true");
  const chosen = [...document.querySelectorAll(".tile[aria-pressed=true]")].map(each => each.dataset.verdict);
  for (const row of document.querySelectorAll("tbody tr"))
    row.hidden = chosen.length > 0 && !chosen.includes(row.dataset.verdict);
};
"""
