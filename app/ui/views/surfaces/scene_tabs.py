"""The right side of the Surfaces view: the scene's parts, its text, its boundary points."""

from __future__ import annotations

from ...panels.side_tabs import SideTabs
from .panel import ScenePanel
from .points_page import PointsPage
from .scene_document import SceneDocument
from .scene_text import SceneText

SCENE, TEXT, POINTS = "Scene", "Text", "Points"


class SceneTabs(SideTabs):
    """Three pages on one scene."""

    def __init__(self, document: SceneDocument) -> None:
        super().__init__()
        self.panel, self.text, self.points = ScenePanel(), SceneText(document), PointsPage()
        self.add_page(SCENE, self.panel, "surfaces, passes, tools and stock")
        self.add_page(TEXT, self.text, "the scene as it is saved")
        self.add_page(POINTS, self.points, "boundary points, where the topmost surface changes")
