"""Scenes as the Surfaces view shows them: what a text comes to is computed, and proven, once a run."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from app.core.progress import NO_PROGRESS, Progress
from app.ui.views.surfaces import scene_computation
from app.ui.views.surfaces.scene_computation import ProvenScene, prove
from app.ui.views.surfaces.shown_scene import ShownScene, shown_scene


class ScenesOnce:
    """What was computed before, by the text that it was computed from; nobody changes it."""

    def __init__(self) -> None:
        self._shown: dict[tuple[bytes, bool], ShownScene] = {}
        self._proven: dict[int, tuple[ShownScene, ProvenScene]] = {}

    def shown_scene(self, path: Path, data: bytes, progress: Progress = NO_PROGRESS, passes: bool = True) -> ShownScene:
        """Return a scene that is computed; one that names files, which may change, is computed each time."""
        if re.search(rb"^\s*file\s*=", data, re.MULTILINE):
            return shown_scene(path, data, progress, passes)
        if (data, passes) not in self._shown:
            self._shown[data, passes] = shown_scene(path, data, progress, passes)
        progress.step(0.9, "Preparing the picture")
        return replace(self._shown[data, passes], path=path)

    def prove(self, shown: ShownScene, progress: Progress) -> ProvenScene:
        """Return a computed scene's program and what is proven of it."""
        if id(shown.computed) not in self._proven:
            self._proven[id(shown.computed)] = shown, prove(shown, progress)
        return self._proven[id(shown.computed)][1]


@pytest.fixture(scope="session")
def scenes_once() -> ScenesOnce:
    return ScenesOnce()


@pytest.fixture(autouse=True)
def each_scene_is_computed_once(scenes_once: ScenesOnce, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_computation, "shown_scene", scenes_once.shown_scene)
    monkeypatch.setattr(scene_computation, "prove", scenes_once.prove)
