"""What lies over a cut while it is played: the tool at its place, and the facets of its sweep."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from ....model.tool import Tool
from ....simulation.gpu.wedges_picture import WedgesPicture, has_wedges
from .cut_picture import CutPicture
from .model import CutModel
from .rendering.cut_scene import CutScene
from .rendering.tool_body import Place
from .tool_outline import DrawnTool, outline_of


class PlaybackOverlay(QObject):
    """Keeps tool and facets until the scene's context is current.

    Signals:
        stirred(): something is to be painted anew. has_wedges(bool): another tool is shown; whether there are facets of
            its sweep. facet(mm): how wide they are.

    Attributes:
        tool: what is shown; None = none. tip: where its tip is, mm.
        wedges: the facets that there are. wedges_on: whether they are seen.
        tool_due, wedges_due: whether they are still to be handed over.
    """

    stirred = Signal()
    has_wedges = Signal(bool)
    facet = Signal(float)

    def __init__(self, model: CutModel, parent: QObject) -> None:
        super().__init__(parent)
        self._model = model
        self.tool: Tool | None = None
        self.tip: Place = (0.0, 0.0, 0.0)
        self.wedges: WedgesPicture | None = None
        self.wedges_on = self.tool_due = self.wedges_due = False

    def show_tool(self, tool: Tool | None, tip: Place | None) -> None:
        """Show a tool with its tip at a place, mm, or none; the same tool elsewhere costs no more than a coarse
        picture.
        """
        tool = tool if tip is not None else None
        if tool == self.tool and (tool is None or tip == self.tip):
            return
        if tool != self.tool:
            self.tool, self.tool_due = tool, True
            self.has_wedges.emit(tool is not None and has_wedges(tool))
        self.tip = tip or self.tip
        self.stirred.emit()

    def show_wedges(self, wedges: WedgesPicture | None) -> None:
        """Have other facets, or none; they are seen where the legend has them switched on."""
        self.wedges = wedges
        if wedges is not None:
            self.facet.emit(wedges.facet)
        if self.wedges_on:
            self._renew_wedges()

    def switch_wedges(self, on: bool) -> None:
        """Let the facets be seen, or not."""
        self.wedges_on = on
        self._renew_wedges()

    def hand_over(self, scene: CutScene) -> None:
        """Hand over what is new, with the scene's context current."""
        if self.tool_due:
            scene.show_tool(drawn_tool(self.tool, self._model.picture))
        if self.wedges_due:
            scene.show_wedges(self.wedges if self.wedges_on else None)
        scene.place_tool(self.tip)
        self.tool_due = self.wedges_due = False

    def _renew_wedges(self) -> None:
        self.wedges_due = True
        self.stirred.emit()


def drawn_tool(tool: Tool | None, picture: CutPicture | None) -> DrawnTool | None:
    """Return a tool as it is painted, in the colour that its cuts have in a picture."""
    if tool is None:
        return None
    moves = picture.moves if picture is not None else None
    return DrawnTool(outline_of(tool), tool.flutes, moves.ink_of(tool.number) if moves is not None else tool.number - 1)
