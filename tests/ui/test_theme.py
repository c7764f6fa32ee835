"""Both themes: text can be read, icons can be seen, every action of the table is there."""

import math

import pytest
from PySide6.QtGui import QColor, QFontMetrics

from app.core.resources import resource
from app.ui.framework.icons import pixmap
from app.ui.framework.style import style_sheet
from app.ui.framework.theme import DARK, LIGHT, text_font
from app.ui.shell.bars.actions import SEPARATOR, menus

LEAST_CONTRAST = 4.5


def luminance(colour: QColor) -> float:
    parts = [
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in (colour.redF(), colour.greenF(), colour.blueF())
    ]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(a: QColor, b: QColor) -> float:
    """WCAG 2 contrast ratio."""
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda t: t.name)
@pytest.mark.parametrize("text", ["ink", "muted", "accent_text", "error", "ok", "warning"])
@pytest.mark.parametrize("ground", ["paper", "canvas", "raised", "chosen", "hover"])
def test_text_can_be_read(theme, text, ground):
    assert contrast(getattr(theme, text), getattr(theme, ground)) >= LEAST_CONTRAST


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda t: t.name)
def test_text_on_the_accent_can_be_read(theme):
    assert contrast(theme.accent_ink, theme.accent) >= LEAST_CONTRAST


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda t: t.name)
def test_style_sheet_names_no_colour_that_is_missing(theme):
    assert "$" not in style_sheet(theme, "arrow.png")


def test_eight_regions_differ_in_both_themes():
    for theme in (LIGHT, DARK):
        assert len({c.name() for c in theme.regions}) == 8


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda t: t.name)
@pytest.mark.parametrize("taken", ["plunge", "contour", "gouge", "left"])
def test_no_region_is_taken_for_something_else(theme, taken):
    other = getattr(theme, taken)
    for region in theme.regions:
        apart = math.dist(region.getRgb()[:3], other.getRgb()[:3])
        assert apart > 45, f"{region.name()} looks like {taken} {other.name()}"


def test_every_icon_draws_something_in_the_colour_asked_for(qapp):
    for path in sorted(resource("icons").glob("*.svg")):
        image = pixmap(path.stem, QColor("#ff0000"), 2).toImage()
        seen = {
            image.pixelColor(x, y).name() for x in range(40) for y in range(40) if image.pixelColor(x, y).alpha() == 255
        }
        assert seen == {"#ff0000"}, path.name


def test_icons_of_the_table_exist_and_keys_are_used_once():
    specs = [spec for _, menu in menus() for spec in menu if spec is not SEPARATOR]
    for spec in specs:
        assert not spec.icon or resource("icons", f"{spec.icon}.svg").exists()
    keys = [spec.key for spec in specs if spec.key]
    assert len(keys) == len(set(keys))


def test_figures_are_of_one_width(qapp):
    metrics = QFontMetrics(text_font())
    assert len({metrics.horizontalAdvance(figure) for figure in "0123456789"}) == 1
