"""A program of its own whose window a file can be dragged out of, as out of a file manager: `python -m … FILE`."""

from __future__ import annotations

import sys

from PySide6.QtCore import QMimeData, QRect, Qt, QUrl
from PySide6.QtGui import QDrag, QMouseEvent
from PySide6.QtWidgets import QApplication, QLabel

PLACE = QRect(1300, 820, 90, 60)
"""On the display, beside a window of 1280 x 800 px."""


class DragSource(QLabel):
    """Gives the file to whoever it is dropped on."""

    def __init__(self, path: str) -> None:
        super().__init__("file")
        self._path = path
        self.setWindowFlags(Qt.WindowType.FramelessWindowHint)
        self.setGeometry(PLACE)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Begin the drag."""
        data, drag = QMimeData(), QDrag(self)
        data.setUrls([QUrl.fromLocalFile(self._path)])
        drag.setMimeData(data)
        drag.exec(Qt.DropAction.CopyAction)


if __name__ == "__main__":
    application = QApplication([])
    source = DragSource(sys.argv[1])
    source.show()
    print("shown", flush=True)
    raise SystemExit(application.exec())
