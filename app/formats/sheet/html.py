"""The sheet as one page of HTML that needs no other file: light or dark on a screen, on A4 when it is printed."""

from __future__ import annotations

from html import escape

import numpy as np

from .content import SetupPicture, SetupSheet, SheetProof, SheetTable, SheetWords
from .layout import BAD, MUTED, box_of

_LOOKS = {True: "holds", False: "fails", None: "unknown"}


def sheet_html(sheet: SetupSheet) -> bytes:
    """Return the sheet as a page in UTF-8."""
    facts = "".join(f"<dt>{escape(fact.label)}</dt><dd>{escape(fact.said)}</dd>" for fact in sheet.facts)
    hashes = "".join(
        f"<tr><td>{escape(each.what)}</td><td><code>{each.sha256}</code></td></tr>" for each in sheet.hashes
    )
    words = sheet.words
    page = _PAGE.format(
        language=sheet.language,
        words=words,
        title=escape(sheet.title),
        program=escape(sheet.program),
        look="open" if sheet.good is None else "good" if sheet.good else "bad",
        verdict=escape(sheet.verdict),
        picture=picture_svg(sheet.picture),
        facts=facts,
        tables="".join(map(_table, sheet.tables)),
        proofs="".join(_proof(proof, words) for proof in sheet.proofs),
        findings=_sentences(words.counts, "counts", sheet.findings) + _sentences(words.remarks, "", sheet.remarks),
        hashes=hashes,
        made_by=escape(sheet.made_by),
        style=_STYLE,
    )
    return page.encode("utf-8", "backslashreplace")


def _table(table: SheetTable) -> str:
    def row(cells: tuple[str, ...], tag: str) -> str:
        looks = [' class="number"' if column.number else "" for column in table.columns]
        return "".join(f"<{tag}{look}>{escape(cell)}</{tag}>" for look, cell in zip(looks, cells, strict=True))

    head = row(tuple(column.title for column in table.columns), "th")
    body = "".join(f"<tr>{row(cells, 'td')}</tr>" for cells in table.rows)
    foot = f"<tfoot><tr>{row(table.total, 'td')}</tr></tfoot>" if table.total else ""
    title = escape(table.title)
    return f"<h2>{title}</h2><div><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody>{foot}</table></div>"


def _proof(proof: SheetProof, words: SheetWords) -> str:
    look, word = _LOOKS[proof.holds], words.verdict(proof.holds)
    claim, bound = escape(proof.claim), escape(proof.bound)
    return f'<tr><td><b>{claim}</b></td><td>{bound}</td><td class="{look}">{word}</td></tr>'


def _sentences(title: str, look: str, sentences: tuple[str, ...]) -> str:
    items = "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences)
    return f'<h2>{title}</h2><ul class="{look}">{items}</ul>' if sentences else ""


_SIZE = 640.0
"""Width of the picture, px."""
_EDGE = 44.0
"""Round the drawing, px."""


def picture_svg(picture: SetupPicture) -> str:
    """Return stock, part and paths as SVG, with the stock's size and the program's zero."""
    x0, y0, x1, y1 = box_of(picture)
    scale = min((_SIZE - 2 * _EDGE) / max(x1 - x0, 1e-6), 520.0 / max(y1 - y0, 1e-6))
    height = scale * (y1 - y0) + 2 * _EDGE
    shift = np.array([_SIZE / 2 - scale * (x0 + x1) / 2, height - _EDGE + scale * y0])
    parts = []
    for line in picture.lines:
        points = np.round(line.points * (scale, -scale) + shift, 2)
        kept = np.append(True, np.any(points[1:] != points[:-1], axis=1))
        data = " ".join(f"{x:g},{y:g}" for x, y in points[kept].tolist())
        dash = f' stroke-dasharray="{" ".join(f"{3 * each:g}" for each in line.pen.dash)}"' if line.pen.dash else ""
        parts.append(f'<path d="M{data}" stroke="{line.pen.colour}" stroke-width="{4 * line.pen.width:g}"{dash}/>')
    if picture.stock is not None:
        left, below = np.array(picture.stock[:2]) * (scale, -scale) + shift
        right, above = np.array(picture.stock[2:]) * (scale, -scale) + shift
        wide, high = (f"{picture.stock[k + 2] - picture.stock[k]:.4g} mm" for k in (0, 1))
        middle, (outside, over) = (above + below) / 2, np.array([x1, y1]) * (scale, -scale) + shift
        parts.append(
            f'<rect x="{left:.1f}" y="{above:.1f}" width="{right - left:.1f}" height="{below - above:.1f}" '
            f'stroke="{MUTED}" stroke-dasharray="8 5"/>'
            f'<text x="{(left + right) / 2:.1f}" y="{over - 10:.1f}" text-anchor="middle">{wide}</text>'
            f'<text x="{outside + 22:.1f}" y="{middle:.1f}" text-anchor="middle" '
            f'transform="rotate(-90 {outside + 22:.1f} {middle:.1f})">{high}</text>'
        )
    if picture.zero is not None:
        x, y = (np.array(picture.zero) * (scale, -scale) + shift).tolist()
        parts.append(
            f'<path stroke="{BAD}" stroke-width="2" d="M{x:.1f},{y:.1f}h44m-8,-4l8,4l-8,4'
            f'M{x:.1f},{y:.1f}v-44m-4,8l4,-8l4,8"/>'
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" stroke="{BAD}" stroke-width="2"/>'
            f'<text x="{x + 50:.1f}" y="{y + 5:.1f}" fill="{BAD}">X</text>'
            f'<text x="{x:.1f}" y="{y - 50:.1f}" fill="{BAD}" text-anchor="middle">Y</text>'
        )
    legend = "".join(
        f'<span><i style="border-top-color:{line.pen.colour}"></i>{escape(word)}</span>'
        for word, line in picture.legend
    )
    size = f'viewBox="0 0 {_SIZE:g} {height:.1f}"'
    return f'<figure><svg {size} fill="none">{"".join(parts)}</svg><figcaption>{legend}</figcaption></figure>'


_PAGE = """\
<!DOCTYPE html>
<html lang="{language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}: {words.sheet}</title>
<style>{style}</style>
</head>
<body>
<header><div><h1>{title}</h1><p>{program}</p></div><p>{words.sheet}</p></header>
<p class="verdict {look}">{verdict}</p>
<section>{picture}<dl>{facts}</dl></section>
{tables}
<h2>{words.certificate}</h2><table class="proofs"><tbody>{proofs}</tbody></table>
{findings}
<h2>SHA-256</h2><table class="hashes"><tbody>{hashes}</tbody></table>
<footer><span>{words.set_up_by} <u></u></span><span>{words.date} <u></u></span><span>{made_by}</span></footer>
</body>
</html>
"""

_STYLE = """
@page { size: A4; margin: 12mm; }
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1e2227; --muted: #5c626a; --line: #c9ccd1; --band: #f1f2ee;
  --good: #0b6b4b; --bad: #b3261e; --open: #8a5a00; }
@media screen and (prefers-color-scheme: dark) { :root { --paper: #17191c; --ink: #e8e8e4; --muted: #a0a6ae;
  --line: #3a3f45; --band: #23272c; --good: #4cc79a; --bad: #ff7b72; --open: #e3a94b; } }
* { box-sizing: border-box; }
body { max-width: 52rem; margin: 1.5rem auto; padding: 0 1.2rem; background: var(--paper); color: var(--ink);
  font: 14px/1.4 Helvetica, Arial, system-ui, "Noto Sans CJK JP", "Hiragino Sans", "Yu Gothic", sans-serif; }
header { display: flex; justify-content: space-between; align-items: baseline; gap: 2rem; color: var(--muted); }
h1 { color: var(--ink); font-size: 1.8rem; line-height: 1.15; margin: 0; overflow-wrap: anywhere; }
header p { margin: .2rem 0; } h2 { font-size: 1.05rem; margin: 1.1rem 0 .35rem; break-after: avoid; }
.verdict { margin: .7rem 0; padding: .5rem .8rem; color: #ffffff; font-weight: 700; print-color-adjust: exact; }
.verdict.good { background: #0b6b4b; } .verdict.bad { background: #b3261e; }
.verdict.open { background: #8a5a00; }
section { display: grid; grid-template-columns: 3fr 2fr; gap: 1.4rem; align-items: start; }
figure { margin: 0; background: #fafaf8; print-color-adjust: exact; } figure svg { display: block; width: 100%; }
figure text { font-size: 15px; fill: #1e2227; }
figcaption { display: flex; flex-wrap: wrap; gap: .2rem 1rem; color: #5c626a;
  font-size: .8rem; padding: .3rem .7rem; } figcaption i { display: inline-block; width: 1.6rem; border-top: 2px solid;
  vertical-align: middle; margin-right: .4rem; }
dl { margin: 0; } dt { color: var(--muted); font-weight: 700; font-size: .78rem; } dd { margin: 0 0 .55rem; }
div { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; } th { background: var(--band); color: var(--muted); font-size: .78rem;
  text-align: left; print-color-adjust: exact; } th, td { padding: .25rem .4rem; vertical-align: top; }
td { border-bottom: 1px solid var(--line); } tr { break-inside: avoid; } tfoot td { font-weight: 700; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.proofs td:first-child { width: 34%; }
.proofs td:last-child { text-align: right; font-weight: 700; white-space: nowrap; }
.holds { color: var(--good); } .fails { color: var(--bad); } .unknown { color: var(--open); }
.counts li::marker { color: var(--bad); } ul { margin: 0; padding-left: 1.2rem; }
.hashes td { font-size: .8rem; } .hashes td:last-child { text-align: right; } code { overflow-wrap: anywhere; }
footer { display: flex; gap: 2rem; margin-top: 1.6rem; color: var(--muted); font-size: .8rem; }
footer span:last-child { margin-left: auto; } footer u { display: inline-block; width: 9rem;
  border-bottom: 1px solid var(--muted); }
@media screen and (max-width: 40rem) { section { grid-template-columns: 1fr; }
  footer { flex-wrap: wrap; gap: .6rem 2rem; } .proofs tr, .hashes tr { display: grid; grid-template-columns: 1fr auto;
  border-bottom: 1px solid var(--line); } .proofs td, .hashes td, .proofs td:first-child { width: auto; border: 0; }
  .proofs td:nth-child(2) { grid-row: 2; grid-column: 1 / -1; padding-top: 0; }
  .hashes td { grid-column: 1 / -1; text-align: left !important; } }
@media screen and (prefers-color-scheme: dark) { figure { filter: invert(.91) hue-rotate(180deg) brightness(1.35); } }
@media print { html { font-size: 12px; } body { margin: 0; padding: 0; max-width: none; font-size: 8.5pt;
  line-height: 1.3; } figure svg { max-height: 76mm; } h2 { margin: .8rem 0 .2rem; } th, td { padding: .15rem .35rem; }
  footer { margin-top: 1rem; } }
"""
