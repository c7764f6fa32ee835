"""The command line and, above it, the log: what was done in words, and what the program said to it."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QSizePolicy, QToolButton, QWidget

from ...framework.boxes import give_ground, put_away, v_box
from ...framework.labels import Elided, restyle
from ...framework.log_view import LogView
from ...framework.theme import mono_font, text_font
from ...framework.themed import Themed
from ...views.language.blocks import depth_change
from ...views.language.completion import CompletionItem, CompletionList
from .command_completion import common_beginning

GOES_ON = "end closes the block, Esc gives it up"
_PENDING_PX = 360
_MOST_REMEMBERED_LINES = 20
_POINT = re.compile(r"\s*[-+@(.\d][^;]*")
Completions = Callable[[str], tuple[str, list[CompletionItem]]]


class CommandLine(Themed, QWidget):
    """A log and a line to type in; Up and Down walk through what was typed before, Tab completes.

    Blocks such as repeat … end may be typed line by line, or pasted; they are entered whole. Pasted rows of coordinates
    are entered one by one, for a tool that asks for points.

    Signals:
        entered(text): Enter with text in the line, or a whole block. accepted(): Enter in the empty line. cancelled():
        Escape with nothing typed. chosen(word): the button of an option.

    Attributes:
        completions: what the end of a line could become, and how much of it there is.
        value_taken: takes a line that Tab ends as a value of the tool in hand, if it is one.
    """

    entered = Signal(str)
    accepted = Signal()
    cancelled = Signal()
    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.log, self.edit = LogView(), QLineEdit()
        self.completions: Completions = lambda line: ("", [])
        self.value_taken: Callable[[str], bool] = lambda text: False
        self.edit.setObjectName("commandLine")
        self.edit.setAccessibleName("Command line")
        self.edit.textChanged.connect(lambda text: self.edit.setFont(mono_font() if text else text_font()))
        self.edit.textEdited.connect(self._on_edited)
        self.edit.installEventFilter(self)
        self.sign, self.pending = QLabel(">"), Elided(role="muted")
        self.options: dict[str, QToolButton] = {}
        self.offers: CompletionList | None = None
        self._prompt = ""
        self._block: list[str] = []
        self._typed: list[str] = []
        self._draft = ""
        self._at = 0
        self._lay_out()
        self.log.recalled.connect(self.recall)

    def _lay_out(self) -> None:
        row = QWidget()
        give_ground(row, "commandRow")
        row.setFixedHeight(31)
        line = self._line = QHBoxLayout(row)
        line.setContentsMargins(16, 0, 16, 0)
        line.setSpacing(8)
        self.sign.setFont(mono_font())
        self.sign.setProperty("role", "prompt")
        self.pending.setMaximumWidth(_PENDING_PX)
        self.pending.setFont(mono_font())
        self.pending.hide()
        for widget, stretch in ((self.pending, 0), (self.sign, 0), (self.edit, 1)):
            line.addWidget(widget, stretch)
        column = v_box(self, spacing=0)
        column.addWidget(self.log)
        column.addWidget(row)

    def set_prompt(self, text: str) -> None:
        """Say what is expected next."""
        self._prompt = text
        self.edit.setPlaceholderText(GOES_ON if self._block else text)

    def set_options(self, words: Sequence[str], on: Collection[str] = ()) -> None:
        """Offer words that the running tool takes, as buttons at the end of the line; those that are on are lit."""
        if list(words) != list(self.options):
            for button in self.options.values():
                self._line.removeWidget(button)
                put_away(button)
            self.options = {word: self._option(word) for word in words}
        for word, button in self.options.items():
            if bool(button.property("on")) != (word in on):
                button.setProperty("on", word in on)
                restyle(button)

    def _option(self, word: str) -> QToolButton:
        button = QToolButton()
        button.setText(word)
        button.setProperty("role", "chip")
        button.setToolTip(f"The same as typing {word}")
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.clicked.connect(lambda: self.chosen.emit(word))
        self._line.addWidget(button)
        return button

    def begin(self, text: str) -> None:
        """Start typing, with the first character that was typed elsewhere."""
        self.edit.setFocus()
        self.edit.insert(text)

    def forget(self) -> None:
        """Let go of what was begun and not entered: something else is done instead."""
        self.edit.setText("")

    def recall(self, text: str) -> None:
        """Put a line back, to be changed or entered again."""
        self.edit.setText("; ".join(line.strip() for line in text.splitlines()))
        self.edit.setFocus()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Enter, Escape, Tab, Up and Down; with nothing typed, keys like Ctrl+Z are the window's."""
        if event.type() == QEvent.Type.ShortcutOverride and not self.edit.text():
            event.ignore()
            return True
        if event.type() == QEvent.Type.FocusOut:
            self._end_offers()
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        return self._answer_offers(event.key()) or self._act(event.key()) or super().eventFilter(watched, event)

    def _act(self, key: int) -> bool:
        """Do what a key stands for; return whether it stands for something."""
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
        elif key == Qt.Key.Key_Escape:
            self._give_up()
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._step(-1 if key == Qt.Key.Key_Up else 1)
        elif key == Qt.Key.Key_Tab and self.edit.text():
            if self.value_taken(self.edit.text()):
                self.edit.setText("")
            else:
                self._complete()
        else:
            return False
        return True

    def _give_up(self) -> None:
        """Give up what is typed; where nothing is, the tool in hand has the key."""
        typed = bool(self._block or self.edit.text())
        self._set_block([])
        self.edit.clear()
        if not typed:
            self.cancelled.emit()

    def _enter(self) -> None:
        text = self.edit.text().strip()
        self.edit.setText("")  # forgets what QLineEdit could undo, which `clear` does not
        if text or self._block:
            self._take([text] if text else [])
        else:
            self.accepted.emit()

    def _on_edited(self, text: str) -> None:
        """Take what was pasted where it has several lines."""
        if "\n" not in text:
            return
        self.edit.setText("")
        lines = [line.rstrip() for line in text.splitlines() if line.strip()]
        if not self._block and all(_POINT.fullmatch(line) for line in lines):
            for line in lines:
                self.entered.emit(line.strip().replace("\t", ","))
        else:
            self._take(lines)

    def _take(self, lines: list[str]) -> None:
        """Enter lines, together with those that wait for their end; or let them wait."""
        block = [*self._block, *lines]
        if sum(depth_change(line)[0] for line in block) > 0 or (block and block[-1].endswith("\\")):
            self._set_block(block)
            return
        self._set_block([])
        self._remember(block)
        if block:
            self.entered.emit("\n".join(block))

    def _set_block(self, block: list[str]) -> None:
        self._block = block
        self.sign.setText("…" if block else ">")
        self.pending.setText(" ; ".join(line.strip() for line in block))
        self.pending.setToolTip("\n".join(block))
        self.pending.setVisible(bool(block))
        self.set_prompt(self._prompt)

    def _remember(self, block: list[str]) -> None:
        if any("#" in line or line.endswith("\\") for line in block):
            self._typed += block[:_MOST_REMEMBERED_LINES]
        elif 0 < len(block) <= _MOST_REMEMBERED_LINES:
            self._typed.append("; ".join(line.strip() for line in block))
        self._at = len(self._typed)

    def _step(self, way: int) -> None:
        if self._at == len(self._typed):
            self._draft = self.edit.text()
        self._at = min(max(self._at + way, 0), len(self._typed))
        self.edit.setText(self._typed[self._at] if self._at < len(self._typed) else self._draft)

    def offer(self) -> None:
        """Take the keys and offer all that the line could become."""
        self.edit.setFocus()
        _, found = self.completions("")
        if found:
            self._show_offers(found)

    def _complete(self) -> None:
        """Write what is certain of the word before the cursor; where there is a choice, offer it."""
        begun, found = self.completions(self.edit.text()[: self.edit.cursorPosition()])
        if len(found) == 1:
            self._put(found[0].word + found[0].behind, begun)
        elif found:
            common = common_beginning([offer.word for offer in found])
            if len(common) > len(begun):
                self._put(common, begun)
            self._show_offers(found)

    def _put(self, word: str, begun: str) -> None:
        self.edit.setSelection(self.edit.cursorPosition() - len(begun), len(begun))
        self.edit.insert(word)

    def _show_offers(self, found: list[CompletionItem]) -> None:
        if self.offers is None:
            self.offers = CompletionList(self.window())
            self.offers.taken.connect(self._take_offer)
        self.offers.set_theme(self._theme)
        place = QRect(self.edit.mapTo(self.window(), self.edit.cursorRect().topLeft()), self.edit.cursorRect().size())
        self.offers.show_offers(found, place.translated(QPoint(-8, 0)), self.window().rect())

    def _take_offer(self, offer: CompletionItem) -> None:
        self._end_offers()
        self._put(offer.word + offer.behind, self.completions(self.edit.text()[: self.edit.cursorPosition()])[0])

    def _end_offers(self) -> None:
        if self.offers is not None:
            self.offers.hide()

    def _answer_offers(self, key: int) -> bool:
        """Let a key choose among the offers, where they are shown; return whether it was for them."""
        if self.offers is None or self.offers.isHidden():
            return False
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Backtab):
            self.offers.step(-1)
        elif key in (Qt.Key.Key_Down, Qt.Key.Key_Tab):
            self.offers.step(1)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.offers.current is not None:
            self._take_offer(self.offers.current)
        elif key == Qt.Key.Key_Escape:
            self._end_offers()
        else:
            self._end_offers()
            return False
        return True
