"""Has every widget speak the user's language: its English text is looked up in the catalogue, and kept to go back to.

What is built or said later is looked up when it is about to be painted or shown as a tip; in English nothing watches.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from PySide6.QtCore import QEvent, QLibraryInfo, QLocale, QObject, QSignalBlocker, Qt, QTranslator
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QLabel,
    QLineEdit,
    QMenu,
    QPlainTextEdit,
    QWidget,
)

from ...core.catalogue import catalogue
from ...core.settings import Language
from ..framework.catalogue import active_language, set_language
from ..framework.commands import Commands, on_trigger
from ..framework.preferences import Preferences


@dataclass(frozen=True)
class _TextSlot:
    """A text of an object: how it is read and written."""

    name: str
    read: Callable[..., str]
    write: Callable[..., None]


_LETTER = re.compile(r"\(&\w\)|&|…")


def _set_action_text(action: QAction, text: str) -> None:
    """Write an action's text, and on buttons the same without the letter to press."""
    action.setText(text)
    action.setIconText(_LETTER.sub("", text))


_TEXT = {
    QAction: (_TextSlot("text", QAction.text, _set_action_text), _TextSlot("tip", QAction.toolTip, QAction.setToolTip)),
    QMenu: (_TextSlot("title", QMenu.title, QMenu.setTitle),),
    QLabel: (_TextSlot("text", QLabel.text, QLabel.setText),),
    QAbstractButton: (_TextSlot("text", QAbstractButton.text, QAbstractButton.setText),),
    QLineEdit: (_TextSlot("placeholder", QLineEdit.placeholderText, QLineEdit.setPlaceholderText),),
    QPlainTextEdit: (_TextSlot("placeholder", QPlainTextEdit.placeholderText, QPlainTextEdit.setPlaceholderText),),
}
_ACCESS = _TextSlot("access", QWidget.accessibleName, QWidget.setAccessibleName)
_WIDGET = (_TextSlot("tip", QWidget.toolTip, QWidget.setToolTip), _ACCESS)
_PAINTED = (QLabel, QAbstractButton, QLineEdit, QComboBox)
_ENGLISH, _SHOWN = Qt.ItemDataRole.UserRole + 101, Qt.ItemDataRole.UserRole + 102
_SEEN = (QEvent.Type.Paint, QEvent.Type.ToolTip)
_DEFAULT_ACTION = "defaultAction"


def _slots(thing: QObject) -> tuple[_TextSlot, ...]:
    own = next((slots for kind, slots in _TEXT.items() if isinstance(thing, kind)), ())
    if hasattr(thing, _DEFAULT_ACTION) and getattr(thing, _DEFAULT_ACTION)() is not None:
        return (_ACCESS,)
    return (*own, *(_WIDGET if isinstance(thing, QWidget) else ()))


def translate(thing: QObject) -> None:
    """Show an object's texts in the language that is spoken; whatever was written since the last time is taken as
    English.
    """
    for slot in _slots(thing):
        text = slot.read(thing)
        source, shown = thing.property(f"english_{slot.name}"), thing.property(f"shown_{slot.name}")
        if shown is None and not text:
            continue
        english = source if text == shown else text
        wanted = catalogue(active_language()).look_up(english) or english
        if wanted != text or shown not in (None, wanted):  # what a button shows of its action may be the old one
            slot.write(thing, wanted)
        if wanted != english or shown is not None:
            thing.setProperty(f"english_{slot.name}", english)
            thing.setProperty(f"shown_{slot.name}", wanted)
    if isinstance(thing, QComboBox):
        _translate_choices(thing)


def _translate_choices(box: QComboBox) -> None:
    """Show what can be chosen; which one is chosen stays."""
    words = catalogue(active_language())
    with QSignalBlocker(box):
        for at in range(box.count()):
            text, shown = box.itemText(at), box.itemData(at, _SHOWN)
            english = box.itemData(at, _ENGLISH) if shown == text else text
            wanted = words.look_up(english) or english
            if wanted != text:
                box.setItemText(at, wanted)
            if wanted != english or shown is not None:
                box.setItemData(at, english, _ENGLISH)
                box.setItemData(at, wanted, _SHOWN)


def translate_all(root: QObject) -> None:
    """Show the texts of an object and of all that belongs to it."""
    for thing in (root, *root.findChildren(QAction), *root.findChildren(QWidget)):
        translate(thing)


class _DeferredTranslation(QObject):
    """Looks up what was written since, just before it is seen."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Before a label or a button is painted, a menu opens or a tip shows."""
        kind = event.type()
        if kind in _SEEN and isinstance(watched, _PAINTED if kind == QEvent.Type.Paint else QWidget):
            translate(watched)
        elif kind == QEvent.Type.Paint and isinstance(text := watched.parent(), QPlainTextEdit):  # this is its viewport
            translate(text)
        elif kind == QEvent.Type.Show and isinstance(watched, QMenu):
            translate_all(watched)
            for action in watched.actions():
                translate(action)
        return False


class TranslationController:
    """View, Language: switches at once and remembers it."""

    def __init__(self, root: QWidget, preferences: Preferences, commands: Commands) -> None:
        """Make one; `root` and what belongs to it speaks the language."""
        self._root, self._preferences, self._commands = root, preferences, commands
        self._later, self._qt = _DeferredTranslation(root), QTranslator(root)
        for choice in Language:
            on_trigger(commands, f"language_{choice.value}", partial(self.choose, choice))
        self._show(preferences.settings.language)

    def choose(self, choice: Language) -> None:
        """Switch, and remember it."""
        self._preferences.keep(replace(self._preferences.settings, language=choice))
        self._show(choice)

    def _show(self, choice: Language) -> None:
        code = code_of(choice)
        application = QApplication.instance()
        assert application is not None
        application.removeEventFilter(self._later)
        application.removeTranslator(self._qt)
        before = active_language()
        set_language(code)
        if code != "en":
            if self._qt.load(f"qtbase_{code}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
                application.installTranslator(self._qt)
            application.installEventFilter(self._later)
        if code != "en" or before != "en":
            translate_all(self._root)
        self._commands[f"language_{choice.value}"].setChecked(True)


def code_of(choice: Language) -> str:
    """Return the code of the language that a choice means; what there is no catalogue for is English."""
    if choice is not Language.SYSTEM:
        return str(choice.value)
    return "ja" if QLocale.system().language() is QLocale.Language.Japanese else "en"
