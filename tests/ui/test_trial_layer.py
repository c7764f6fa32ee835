"""What a command would make is painted from paths that are built once."""

from app.drafting.difference import difference
from app.drafting.document import Document
from app.ui.views.canvas.painting.overlay import TrialLayer


def test_the_paths_of_a_trial_are_built_once_and_anew_for_another() -> None:
    document, picture = Document(), TrialLayer()
    document.run("line 0,0 40,0; select 1")
    moved = difference(document.part, document.tried("move @0,7").part)
    gone, added = picture.paths(moved)
    assert (gone.boundingRect().top(), added.boundingRect().top()) == (0, 7)
    assert picture.paths(moved)[0] is gone
    assert picture.paths(moved)[1] is added
    copied = difference(document.part, document.tried("copy @0,9").part)
    gone, added = picture.paths(copied)
    assert gone.isEmpty()
    assert added.boundingRect().top() == 9
