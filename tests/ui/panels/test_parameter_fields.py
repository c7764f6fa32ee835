"""The form of an operation comes from the declarations: a parameter that is added shows by itself, and what it shows is
what is set.
"""

import pytest

from app.drafting.document import Document
from app.model import operation_kinds as operations
from app.model.chamfer_operation import ChamferOperation
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer
from app.model.fields import parameters_of
from app.model.job import Job
from app.model.operation import CutParameters, Side
from app.model.operation_kinds import OPERATION_KINDS, register
from app.model.part import Part
from app.ui.framework.catalogue import set_language, tr
from app.ui.framework.fields import ChoiceField, ListField, NumberField
from app.ui.framework.form import SwitchField
from app.ui.panels.operation_form import OperationForm
from app.ui.panels.operation_groups import SPAN, curve_words
from tests.model.test_fields import ASKED, EngraveOperation, Grain


@pytest.fixture
def form(qtbot, monkeypatch):
    monkeypatch.setattr(operations, "OPERATION_KINDS", dict(OPERATION_KINDS))
    register(EngraveOperation)
    made = OperationForm()
    qtbot.addWidget(made)
    return made


def job_of(kind):
    return Job(Part(), operations=(kind(CutParameters(2)),))


@pytest.mark.parametrize("kind", [*OPERATION_KINDS.values(), EngraveOperation], ids=lambda kind: kind.WORD)
def test_the_fields_are_those_of_the_kind(form, kind):
    form.show_operation(job_of(kind), 0, None)
    shown = {key for key, each in form.fields.items() if not each.field.isHidden()}
    operation = job_of(kind).operations[0]
    assert shown == {key for key, placed in parameters_of(kind).items() if placed.has_effect(operation)} - {
        "tool",
        "enabled",
        "tab_places",
    }


def test_a_kind_from_outside_is_set_in_the_form(form):
    document = Document(job_of(EngraveOperation))
    form.edited.connect(lambda edit: document.change_job(edit.name, edit.make(document.job)))
    form.show_operation(document.job, 0, None)
    fields = {key: form.fields[key].field for key in ASKED}
    assert [type(field) for field in fields.values()] == [NumberField, ChoiceField, NumberField, SwitchField]
    for key, text in (("overcut", "1.25"), ("slant", "12.5")):
        fields[key].edit.setText(text)
        fields[key].edit.setModified(True)
        fields[key].edit.editingFinished.emit()
    fields["grain"].buttons[Grain.ACROSS].click()
    fields["twice"].switch.click()
    (made,) = document.job.operations
    assert {key: parameters_of(EngraveOperation)[key].of(made) for key in ASKED} == {
        **ASKED,
        "slant": pytest.approx(ASKED["slant"]),
    }
    assert document.undo_name == "Change twice"


def test_what_is_out_of_range_is_said_at_the_field(form):
    form.show_operation(job_of(EngraveOperation), 0, None)
    field = form.number("overcut")
    field.edit.setText("10")
    field.edit.textEdited.emit("10")
    assert field.reason.text() == "Overcut is 10 mm; use 0 to 9."


def test_long_choices_are_a_list(form):
    assert isinstance(form.fields["entry"].field, ListField)
    assert isinstance(form.fields["side"].field, ChoiceField)


def test_what_a_kind_refuses_is_not_offered(form):
    def offered(kind):
        form.show_operation(job_of(kind), 0, None)
        buttons = form.fields["side"].field.buttons
        return [side for side, button in buttons.items() if not button.isHidden()]

    assert offered(ChamferOperation) == [Side.INSIDE, Side.OUTSIDE]
    assert offered(ContourOperation) == [Side.INSIDE, Side.OUTSIDE, Side.ON]


@pytest.fixture
def language():
    """What switches the language of the window, until the test ends."""
    yield set_language
    set_language("en")


def test_curves_of_an_operation_are_told_as_a_person_says_them():
    curves = (CirclesOf(6.0, 6.0), CirclesOf(5.9, 6.1), OnLayer("holes"), *ContourKind, CurveNumber(12))
    places = ["outer contours", "inner contours", "open lines"]
    words = ["Ø 6 mm", f"Ø 5.9{SPAN}6.1 mm", "layer holes", *places, "curve 12"]
    assert [curve_words([each]) for each in curves] == words
    assert curve_words([CurveNumber(3), CurveNumber(4), ContourKind.OUTER]) == "outer contours, 2 curves"


def test_lists_of_curves_are_told_in_the_language_of_the_window(language):
    ways = {
        (ContourKind.OUTER, ContourKind.INNER): "外側の輪郭、内側の輪郭",
        (CirclesOf(5.0, 6.0), ContourKind.OPEN): f"Ø 5{SPAN}6 mm、開いた線",
        (ContourKind.OUTER, OnLayer("A")): "外側の輪郭、レイヤー A",
        (ContourKind.OUTER, *map(CurveNumber, (3, 4, 5))): "外側の輪郭、図形 3 個",
        (ContourKind.INNER, CurveNumber(3)): "内側の輪郭、図形 3",
    }
    language("ja")
    assert {each: curve_words(each) for each in ways} == ways
    assert [tr(curve_words([each])) for each in (ContourKind.OUTER, CurveNumber(7))] == ["外側の輪郭", "図形 7"]
