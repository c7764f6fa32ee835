"""The style sheet and palette made from a theme: flat, hairlines, a 4 px grid."""

from __future__ import annotations

from string import Template

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication

from .theme import Theme, mixed, text_font

_BARS = """
QMainWindow, QWidget#root { background: $paper; }
QMenuBar { background: $paper; padding: 2px 8px; color: $ink; }
QMenuBar::item { padding: 5px 9px; border-radius: 4px; background: transparent; }
QMenuBar::item:selected { background: $hover; }
QMenu { background: $raised; color: $ink; border: 1px solid $hairline; padding: 4px; }
QMenu::item { padding: 5px 28px 5px 24px; border-radius: 4px; }
QMenu::item:selected { background: $chosen; color: $ink; }
QMenu::item:disabled { color: $muted; }
QMenu::separator { height: 1px; background: $hairline; margin: 4px 8px; }
QMenu::indicator { width: 8px; height: 8px; left: 8px; border-radius: 4px; }
QMenu::indicator:checked { background: $accent; }
QToolTip { background: $ink; color: $paper; border: 0; padding: 4px 8px; }
QWidget#topBar, QWidget#statusBar, QWidget#toolStrip, QWidget#sidePanel, QWidget#logArea, QWidget#commandRow { background: $paper; }
QWidget#topBar { border-bottom: 1px solid $hairline; }
QFrame#variants { background: $raised; border: 1px solid $edge; border-radius: 4px; }
QWidget#toolStrip { border-right: 1px solid $hairline; }
QWidget#sideTabs { background: $paper; }
QWidget#logArea, QWidget#commandRow, QWidget#statusBar { border-top: 1px solid $hairline; }
QFrame#startCard { background: $raised; border: 1px solid $hairline; border-radius: 6px; }
QFrame#hairline { background: $hairline; border: 0; }
QWidget#cutView { background: $canvas; }
QWidget#ncBar { background: $paper; border-bottom: 1px solid $hairline; }
QWidget#ncPlaces { background: $paper; border-top: 1px solid $hairline; }
QAbstractScrollArea::corner { background: transparent; border: 0; }
QSplitter::handle { background: $hairline; }
QLabel { color: $ink; background: transparent; }
QLabel[role="muted"] { color: $muted; }
QLabel[role="error"] { color: $error; }
QLabel[role="ok"] { color: $ok; }
QLabel[role="warning"] { color: $warning; }
QLabel[role="prompt"] { color: $accent_text; font-weight: 600; }
"""

_BUTTONS = """
QToolButton { border: 0; border-radius: 4px; background: transparent; color: $ink; padding: 0; }
QToolButton:hover { background: $hover; }
QToolButton:focus { border: 1px solid $accent_text; }
QToolButton:disabled { color: $muted; }
QWidget#toolStrip QToolButton:checked, QFrame#variants QToolButton:checked { background: $chosen; }
QToolButton[role="tab"] { border-radius: 0; padding: 0 10px; color: $muted;
  border-bottom: 2px solid transparent; border-top: 2px solid transparent; }
QToolButton[role="tab"]:hover { color: $ink; background: transparent; }
QToolButton[role="tab"]:checked { color: $ink; font-weight: 600; border-bottom-color: $accent; }
QToolButton[role="tab"]:focus { border-left: 0; border-right: 0; border-top: 2px solid transparent; color: $ink; background: $hover; }
QToolButton[role="fold"] { padding: 2px 6px 2px 2px; font-weight: 600; }
QToolButton[role="fold"]:focus { background: $hover; }
QToolButton[role="choice"] { border-radius: 0; padding: 3px 1px; color: $muted; border-bottom: 2px solid transparent; }
QToolButton[role="choice"]:hover { color: $ink; background: transparent; }
QToolButton[role="choice"]:checked { color: $ink; font-weight: 600; border-bottom-color: $accent; }
QToolButton[role="choice"]:focus { color: $accent_text; background: $hover; }
QToolButton[role="toggle"] { padding: 2px 5px; color: $muted; }
QToolButton[role="toggle"]:checked { color: $ink; }
QToolButton[role="toggle"][popupMode="1"] { padding-right: 16px; }
QToolButton[role="toggle"]::menu-button { border: none; width: 14px; }
QToolButton[role="toggle"]::menu-arrow { image: url($arrow); width: 10px; height: 10px; }
QWidget#selectionRibbon { background: $raised; border: 1px solid $edge; border-radius: 6px; }
QToolButton[role="ribbon"] { padding: 4px 8px; }
QToolButton[role="word"] { background: $raised; border: 1px solid $edge; border-radius: 9px; padding: 1px 8px 1px 18px; }
QToolButton[role="word"]:hover { background: $hover; }
QToolButton[role="chip"] { border: 1px solid $edge; padding: 1px 8px; }
QToolButton[role="chip"][on="true"] { background: $chosen; border-color: $accent_text; }
QPushButton { background: $raised; color: $ink; border: 1px solid $edge; border-radius: 4px; padding: 5px 12px; }
QPushButton:hover { background: $hover; }
QPushButton:focus { border-color: $accent_text; }
QPushButton:disabled { color: $muted; border-color: $hairline; }
QPushButton[role="primary"] { background: $accent; color: $accent_ink; border-color: $accent; font-weight: 600; }
QPushButton[role="primary"]:hover { background: $accent_hover; }
QPushButton[role="primary"]:focus { border-color: $ink; }
QPushButton[role="primary"]:disabled { background: $hover; color: $muted; border-color: $hairline; }
QPushButton[role="link"] { border: 0; background: transparent; color: $accent_text; padding: 2px 4px; text-align: left; }
QPushButton[role="link"]:hover { text-decoration: underline; }
QPushButton[role="drop"] { border: 0; border-bottom: 1px solid $edge; border-radius: 0; padding: 2px 6px; }
QPushButton[role="drop"]:focus { border-bottom: 1px solid $accent_text; }
QPushButton[role="drop"]::menu-indicator { image: url($arrow); width: 12px; height: 12px; right: 4px;
  subcontrol-origin: padding; subcontrol-position: center right; }
QPushButton[role="badge"] { border: 0; border-radius: 4px; padding: 3px 12px; font-weight: 600; background: $hover; color: $muted; }
QPushButton[role="badge"][verdict="ok"] { background: $ok_fill; color: $ok; }
QPushButton[role="badge"][verdict="remark"] { background: $warning_fill; color: $warning; }
QPushButton[role="badge"][verdict="bad"] { background: $gouge_fill; color: #FFFFFF; }
QPushButton[role="badge"]:focus { border: 1px solid $accent_text; padding: 2px 11px; }
"""

_FIELDS = """
QLineEdit { background: $raised; color: $ink; border: 0; border-bottom: 1px solid $edge; padding: 2px 6px;
  selection-background-color: $accent; selection-color: $accent_ink; }
QLineEdit:focus { border-bottom: 1px solid $accent_text; }
QLineEdit[wrong="true"], QComboBox[wrong="true"] { border-bottom: 1px solid $error; color: $error; }
QLineEdit#commandLine { background: transparent; border: 0; padding: 0; }
QComboBox { background: $raised; color: $ink; border: 0; border-bottom: 1px solid $edge; padding: 2px 6px; min-height: 18px; }
QComboBox:focus { border-bottom: 1px solid $accent_text; }
QComboBox::drop-down { border: 0; width: 18px; }
QComboBox::down-arrow { image: url($arrow); width: 12px; height: 12px; }
QComboBox QAbstractItemView { background: $raised; color: $ink; border: 1px solid $hairline; outline: 0;
  selection-background-color: $chosen; selection-color: $ink; }
QPlainTextEdit#chainText { background: $raised; border: 0; border-bottom: 1px solid $edge; }
QListWidget { background: transparent; border: 0; outline: 0; padding: 0 4px; }
QListWidget::item { padding: 3px 8px; border-radius: 4px; }
QListWidget::item:hover { background: $hover; }
QListWidget::item:selected { background: $chosen; color: $ink; }
QListWidget[role="rows"] { padding: 0; }
QListWidget[role="rows"]::item { padding: 3px 13px; border-radius: 0; }
QTreeWidget { background: transparent; border: 0; outline: 0; }
QTreeWidget::item { padding: 4px 8px; }
QTreeWidget::item:hover { background: $hover; }
QTreeWidget::item:selected { background: $chosen; color: $ink; }
QHeaderView::section { background: $paper; color: $muted; border: 0; border-bottom: 1px solid $hairline; padding: 4px 8px; }
QScrollArea, QScrollArea > QWidget > QWidget { background: transparent; border: 0; }
QScrollBar:vertical { background: transparent; width: 8px; margin: 0; }
QScrollBar:horizontal { background: transparent; height: 8px; margin: 0; }
QScrollBar::handle { background: $edge; border-radius: 3px; min-height: 24px; min-width: 24px; margin: 1px; }
QScrollBar::handle:hover { background: $muted; }
QScrollBar::add-line, QScrollBar::sub-line, QScrollBar::add-page, QScrollBar::sub-page { background: transparent; width: 0; height: 0; }
QProgressBar { background: $hairline; border: 0; border-radius: 2px; }
QProgressBar::chunk { background: $accent; border-radius: 2px; }
QWidget#notice { background: $notice; border-bottom: 1px solid $hairline; }
QWidget#card { background: $paper; border-bottom: 1px solid $hairline; }
QWidget#notice[error="true"] { background: $notice_error; }
QFrame#ring { border: 2px solid $accent; border-radius: 6px; background: transparent; }
QFrame#findings, QFrame#palette, QFrame#callout { background: $raised; border: 1px solid $edge; border-radius: 4px; }
QWidget[row="true"] { background: transparent; }
QWidget[row="true"]:hover { background: $hover; }
QWidget[row="true"][chosen="true"] { background: $chosen; }
QWidget[row="true"]:focus { border-left: 2px solid $accent; }
QDialog { background: $paper; }
"""


def _mix(a: QColor, b: QColor, part: float) -> str:
    """Return `part` of b in a, as "#rrggbb"."""
    return mixed(a, b, part).name()


def style_sheet(theme: Theme, arrow: str = "") -> str:
    """Return the window's style sheet.

    Args:
        theme: colours.
        arrow: path of the picture for the arrow of drop-down fields, with forward slashes.
    """
    dark = theme.name == "dark"
    colours = theme.hex_colours() | {
        "edge": _mix(theme.paper, theme.ink, 0.24),
        "accent_hover": _mix(theme.accent, theme.paper, 0.18),
        "ok_fill": theme.chosen.name(),
        "warning_fill": _mix(theme.paper, theme.contour, 0.2),
        "gouge_fill": "#D32F2F",
        "notice": _mix(theme.paper, theme.accent, 0.10 if dark else 0.12),
        "notice_error": _mix(theme.paper, theme.error, 0.12),
        "arrow": arrow,
    }
    return Template(_BARS + _BUTTONS + _FIELDS).substitute(colours)


def palette(theme: Theme) -> QPalette:
    """Return the palette for what a style sheet does not reach (dialogs, selections)."""
    made = QPalette()
    roles = QPalette.ColorRole
    pairs = {
        roles.Window: theme.paper,
        roles.Base: theme.raised,
        roles.AlternateBase: theme.hover,
        roles.Button: theme.paper,
        roles.WindowText: theme.ink,
        roles.Text: theme.ink,
        roles.ButtonText: theme.ink,
        roles.ToolTipBase: theme.ink,
        roles.ToolTipText: theme.paper,
        roles.Highlight: theme.accent,
        roles.HighlightedText: theme.accent_ink,
        roles.PlaceholderText: theme.muted,
        roles.Link: theme.accent_text,
    }
    for role, colour in pairs.items():
        made.setColor(role, colour)
    return made


def prepare(app: QApplication, theme: Theme) -> None:
    """Give the whole program the theme's type and palette: what widgets measure themselves with while they are made."""
    if app.style().objectName() != "fusion":
        app.setStyle("Fusion")
    app.setFont(text_font())
    app.setPalette(palette(theme))


def apply(app: QApplication, theme: Theme, arrow: str = "") -> None:
    """Give the whole program the theme's type, palette and style sheet; where it has them already, nothing is done
    anew.

    A style sheet is worked out again for all that a widget holds whenever that is put into something else, so it is
    cheapest when everything has found its place.
    """
    sheet = style_sheet(theme, arrow)
    if app.styleSheet() == sheet:
        return
    app.setStyleSheet("")  # under a sheet, type and palette would each have it worked out anew for every widget
    prepare(app, theme)
    app.setStyleSheet(sheet)
