"""The boundary points of a scene as a table: which surfaces meet, on which plane, where, and how."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView, QWidget

from ....usecases.scene.lines import BoundaryPoint
from ...framework.boxes import v_box
from ...framework.figures import counted
from ...framework.labels import muted
from ...framework.theme import Theme

WIDTH = 440
_HEADS = ("", "Plane", "X", "Y", "Z", "Kind")
_TIPS = (
    "The surfaces that meet, by their numbers",
    "Cutting plane, counted over all passes",
    "mm",
    "mm",
    "mm",
    "crossing; edge: one ends; jump: two heights at one place; tangent: they touch",
)
_CELLS = "QTableView::item { padding-left: 12px; padding-right: 4px; }"
_Index = QModelIndex | QPersistentModelIndex


class PointsModel(QAbstractTableModel):
    """The rows for Qt."""

    def __init__(self) -> None:
        super().__init__()
        self.points: tuple[BoundaryPoint, ...] = ()

    def show_points(self, points: tuple[BoundaryPoint, ...]) -> None:
        """Show other points."""
        self.beginResetModel()
        self.points = points
        self.endResetModel()

    def rowCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: N802, B008 (Qt's)
        """As many as there are points."""
        return 0 if parent.isValid() else len(self.points)

    def columnCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: N802, B008 (Qt's)
        """Name, plane, place, kind."""
        return 0 if parent.isValid() else len(_HEADS)

    def data(self, index: _Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Text and alignment."""
        if role == Qt.ItemDataRole.TextAlignmentRole and 1 <= index.column() <= 4:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        row = self.points[index.row()]
        return (row.name, str(row.plane + 1), *(f"{value:.3f}" for value in row.place.tolist()), row.kind)[
            index.column()
        ]

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:  # noqa: N802 (Qt's)
        """Name of a column."""
        if orientation is Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return _HEADS[section]
        if orientation is Qt.Orientation.Horizontal and role == Qt.ItemDataRole.TextAlignmentRole:
            side = Qt.AlignmentFlag.AlignRight if 1 <= section <= 4 else Qt.AlignmentFlag.AlignLeft
            return int(side | Qt.AlignmentFlag.AlignVCenter)
        if orientation is Qt.Orientation.Horizontal and role == Qt.ItemDataRole.ToolTipRole:
            return _TIPS[section]
        return None


class PointsPage(QWidget):
    """The table; a click shows the point.

    Signals:
        chosen(number): of the row.
    """

    chosen = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(WIDTH)
        self.model, self.table, self.summary = PointsModel(), QTableView(), muted()
        self.summary.setContentsMargins(16, 8, 16, 8)
        self.summary.setWordWrap(True)
        self.table.setModel(self.model)
        self.table.setFrameShape(QTableView.Shape.NoFrame)
        self.table.setShowGrid(False)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(24)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setAccessibleName("Boundary points")
        header = self.table.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(40)
        for column, wide in enumerate((72, 52, 76, 76, 76)):
            header.resizeSection(column, wide)
        header.setSectionResizeMode(5, QHeaderView.ResizeMode.Stretch)
        whole = v_box(self, spacing=0)
        whole.addWidget(self.summary)
        whole.addWidget(self.table, 1)
        self.table.selectionModel().currentRowChanged.connect(
            lambda now, _: self.chosen.emit(now.row()) if now.isValid() else None
        )
        self.show_points(())

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        chosen = f"selection-background-color: {theme.chosen.name()}; selection-color: {theme.ink.name()};"
        self.table.setStyleSheet(f"QTableView {{ background: {theme.paper.name()}; {chosen} }} {_CELLS}")

    def show_points(self, points: tuple[BoundaryPoint, ...]) -> None:
        """Show other points."""
        self.model.show_points(points)
        self.summary.setText(
            f"{counted(len(points), 'boundary point')}: where the topmost surface changes"
            if points
            else "No boundary points: one surface is on top all along."
        )
        self.table.setVisible(bool(points))

    def choose(self, number: int) -> None:
        """Mark a row and bring it into sight."""
        self.table.selectRow(number)
