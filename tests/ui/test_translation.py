"""The window in Japanese: every menu, what is said later, and English again without a trace."""

from __future__ import annotations

import ast
import re
import tomllib
import unicodedata
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QLocale, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPlainTextEdit,
    QStyleOptionViewItem,
    QWidget,
)

import app
from app.core.catalogue import Catalogue, catalogue, catalogue_files
from app.core.settings import Language, load_settings
from app.drafting.document import Document
from app.formats.drawing import LeftOutReason, LeftOutSort
from app.formats.drawing_account import all_left_out
from app.model.curve_selectors import ContourKind
from app.model.finding import Finding, FindingKind
from app.ui.framework.catalogue import set_language, tr
from app.ui.framework.fields import LABEL_WIDTH, NumberField, NumberSpec
from app.ui.framework.figures import counted
from app.ui.framework.legend import LegendRow
from app.ui.framework.samples import PathLineKind
from app.ui.framework.theme import TEXT_PX
from app.ui.framework.verdict import verdict_summary
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.library import about_tool
from app.ui.shell.bars.actions import menus, plain
from app.ui.shell.help.about import show_about
from app.ui.shell.translation import code_of, translate, translate_all
from app.ui.shell.view_pages import NO_PART
from app.ui.shell.view_stack import EmptyState
from app.ui.views.canvas.prompt_tool import PromptTool
from app.ui.views.canvas.tool_table import TOOLS
from app.ui.views.nc.places_panel import ListedPlace, PlacesPanel, PlaceWeight
from app.usecases.proposal.propose import shipped_tools

FILES = {path: tomllib.loads(path.read_text("utf-8"))["words"] for path in catalogue_files("ja")}
ENTRIES: dict[str, str] = {text: other for words in FILES.values() for text, other in words.items()}
HOLE = re.compile(r"\{n?\}")
NUMBERED = re.compile(r"\{(\d+)\}")
OWN_NAMES = {"English", "日本語", "NC"}


@pytest.fixture(autouse=True)
def english_again():
    yield
    set_language("en")


@pytest.fixture
def japanese(wiring):
    wiring.window_.actions_["language_ja"].trigger()
    return wiring


@pytest.mark.parametrize(
    ("english", "japanese"),
    [
        ("1.5 mm² left within reach", "届く所の削り残し 1.5 mm²"),
        (
            "2.655 mm² in 11 places is out of reach of every tool; a disc of 0.513 mm would fit at (6.257, 6.257); "
            "a smaller contour tool reaches farther.",
            "2.655 mm² (11 か所) にはどの工具も届きません。直径 0.513 mm の円が (6.257, 6.257) に入る大きさです。"
            "細い輪郭工具なら先まで届きます。",
        ),
        (
            "Read back within 0.0001 mm; cut out of its stock, 7\u2009990 mm³ of it; no gouge (0.0000 mm), nothing "
            "left within reach, no rapid in metal; no point between the cells deeper than 0.150 mm into the part.",
            "読み返しの差 0.0001 mm 以内。素材から 7\u2009990 mm³ を切削: 食込みなし (0.0000 mm)、"
            "届く所の削り残しなし、素材内の早送りなし。セルの間でも部品への食込みは 0.150 mm 以下。",
        ),
        (
            "T1 flat 6 mm: 1 entry is straight down as no ramp fits, at (43.929, 9.286); 3 entries are a helix as no "
            "drilled hole is near, the first at (1.000, -2.000).",
            "T1 フラット 6 mm: ランプが収まらないため、まっすぐ降りる進入が 1 か所 ((43.929, 9.286))。"
            "近くに下穴がないため、ヘリカルの進入が 3 か所 (最初は (1.000, -2.000))。",
        ),
        ("No findings, 1 remark", "問題なし、備考 1 件"),
        ("2 findings, 1 remark", "検査結果 2 件、備考 1 件"),
    ],
)
def test_what_is_proven_and_found_is_said_whole(english: str, japanese: str) -> None:
    assert catalogue("ja").look_up(english) == japanese


def test_an_empty_state_is_as_wide_as_its_words_in_the_language(qtbot) -> None:
    set_language("ja")
    parent = QWidget()
    qtbot.addWidget(parent)
    parent.resize(900, 400)
    empty = EmptyState(parent)
    parent.show()
    for sentence in (NO_PART.sentence, "Computing tool paths."):
        empty.say(sentence, "Open drawing")
        translate(empty.sentence)  # as when it is painted
        qtbot.waitUntil(lambda: empty.size() == empty.sizeHint())
        assert empty.sentence.width() >= empty.sentence.sizeHint().width()


def test_a_row_of_the_legend_is_read_whole_in_the_language(qtbot) -> None:
    set_language("ja")
    row = LegendRow(PathLineKind.POCKET)
    qtbot.addWidget(row)
    for count in range(1, 6):
        row.show_names("Pocket", [f"T{number}" for number in range(1, count + 1)], 180)
        assert row.label.fontMetrics().horizontalAdvance(tr(row.label.text())) <= 180 - 76


def texts(window: QWidget) -> list[str]:
    found = [action.text() + action.toolTip() + action.iconText() for action in window.findChildren(QAction)]
    found += [each.text() + each.toolTip() for kind in (QLabel, QAbstractButton) for each in window.findChildren(kind)]
    return [*found, *(menu.title() for menu in (action.menu() for action in window.menuBar().actions()))]


def ems(text: str) -> float:
    """How wide a text is at most, in its height: Japanese letters are square, others at most 0.65 wide."""
    return sum(1.0 if unicodedata.east_asian_width(letter) in "WF" else 0.65 for letter in text)


def test_every_menu_has_a_japanese_text_that_is_not_long() -> None:
    texts = [plain(text) for title, specs in menus() for text in (title, *(spec.text for spec in specs if spec.text))]
    missing = sorted({text for text in texts if text not in OWN_NAMES and text not in ENTRIES})
    assert not missing
    assert {text: ENTRIES[text] for text in texts if text in ENTRIES and ems(ENTRIES[text]) > 18} == {}


def test_entries_keep_their_holes_and_say_something() -> None:
    wrong = {text for text, other in ENTRIES.items() if not holes_agree(text, other) or not other.strip()}
    assert not wrong


def test_every_entry_stands_in_one_file() -> None:
    assert len(FILES) > 5 and sum(map(len, FILES.values())) == len(ENTRIES)


def holes_agree(text: str, other: str) -> bool:
    """Every hole stands in the translation too: as it is, or all of them by their numbers, in any order."""
    numbered = {int(number) for number in NUMBERED.findall(other)}
    if numbered and not HOLE.search(other):
        return numbered == set(range(len(HOLE.findall(text))))
    return not numbered and sorted(HOLE.findall(text)) == sorted(HOLE.findall(other))


def test_names_of_fields_fit_before_their_values(japanese) -> None:
    names = {field.spec.name for field in japanese.window_.findChildren(NumberField)} & set(ENTRIES)
    assert len(names) > 10
    assert {name: ENTRIES[name] for name in names if ems(ENTRIES[name]) * TEXT_PX > LABEL_WIDTH} == {}


def test_the_window_speaks_japanese_at_once_and_remembers_it(japanese) -> None:
    window = japanese.window_
    assert window.menuBar().actions()[0].text() == "ファイル(&F)"
    assert window.actions_["open"].text() == "開く(&O)…"
    assert window.actions_["open"].toolTip() == "開く (Ctrl+O)"
    assert window.top_bar.tabs["view_draw"].text() == "作図"
    assert window.top_bar.compute.text() == " 計算  F5"
    assert window.side.tabs["Job"].text() == "加工"
    assert window.status.snap.text() == "スナップ"
    assert load_settings().language is Language.JAPANESE


def test_what_is_said_later_is_looked_up_before_it_is_seen(qtbot, japanese) -> None:
    window = japanese.window_
    japanese.document.run("line 0,0 10,0")
    japanese.files.ask_new()
    QApplication.processEvents()
    window.grab()
    assert window.notice.text.text() == "新しい図面を始めますか。この図面はまだどのファイルにも保存されていません。"
    assert "作図を続ける" in [button.text() for button in window.notice.buttons]
    japanese.cancel()
    japanese.display_controller.show_hovered("Cancelled; nothing has changed.")
    window.grab()
    assert window.status.message.text() == "中止しました。何も変更していません。"


def test_what_an_empty_field_stands_for_is_shown_and_understood_in_the_language(qtbot) -> None:
    set_language("ja")
    field = NumberField(NumberSpec("Stepover", auto="auto"))
    qtbot.addWidget(field)
    field.show_value(None)
    translate_all(field)
    assert (field.edit.text(), field.edit.placeholderText()) == ("", "自動")
    for word in ("自動", "auto", ""):
        field.show_value(2.0)
        field.edit.setText(word)
        field.edit.setModified(True)
        field.commit()
        assert field.value is None and field.reason.text() == "", word


def test_what_an_empty_text_stands_for_is_looked_up_when_it_is_seen(qtbot, japanese) -> None:
    panel = japanese.window_.stages_panel.chains
    panel.text.setPlaceholderText("This step traces no line.")
    panel.text.viewport().grab()
    assert panel.text.placeholderText() == "この段階では線をたどりません。"


def test_lists_of_curves_follow_the_language(wiring) -> None:
    """Made of pieces in the language that was spoken then, they would stay in it."""
    wiring.run("rect 0,0 60,40")
    panel, (first, *others) = wiring.window_.panel, wiring.document.job.operations
    cut = replace(first.cut, curves=(ContourKind.OUTER, ContourKind.INNER))
    panel.change("Curves", lambda job: replace(job, operations=(replace(first, cut=cut), *others)))
    panel.choose(Subject(SubjectKind.OPERATION, 0))
    box, told = panel.operation_form.fields["curves"].field.box, []
    for code in ("en", "ja", "en"):
        wiring.window_.actions_[f"language_{code}"].trigger()
        told.append(box.currentText())
    assert told == ["outer contours, inner contours", "外側の輪郭、内側の輪郭", "outer contours, inner contours"]


@pytest.mark.parametrize("more", [0, 2])
@pytest.mark.parametrize("kind", FindingKind)
def test_the_badge_tells_each_kind_of_finding_and_that_there_are_more(kind, more) -> None:
    found = tuple(Finding(kind, "A sentence.", x=1.0, y=2.0, amount=0.1) for _ in range(more + 1))
    words, japanese = verdict_summary(found, {"moves": {"line": 1}}).text, catalogue("ja")
    told = japanese.look_up(words)
    assert told is not None and not re.search("[a-z]{3}", told), (words, told)
    assert japanese.look_up(f"Preview · {words}") == f"プレビュー · {told}"


def test_english_comes_back_without_a_trace(wiring) -> None:
    before = texts(wiring.window_)
    wiring.window_.actions_["language_ja"].trigger()
    wiring.window_.grab()
    assert texts(wiring.window_) != before
    wiring.window_.actions_["language_en"].trigger()
    assert texts(wiring.window_) == before


def test_undo_names_what_it_takes_back(qtbot, japanese) -> None:
    japanese.document.run("line 0,0 10,0")
    edit = japanese.window_.menuBar().actions()[1].menu()
    edit.popup(japanese.window_.pos())
    qtbot.waitUntil(lambda: edit.isVisible())
    assert japanese.window_.actions_["undo"].text().startswith("元に戻す: ")
    edit.hide()


def test_the_palette_finds_in_both_languages(qtbot, japanese) -> None:
    for typed in ("全体", "fit"):
        japanese.palette.open()
        qtbot.keyClicks(japanese.palette.edit, typed) if typed == "fit" else japanese.palette.edit.setText(typed)
        assert japanese.palette.list.count() > 0


def test_one_entry_serves_menu_tip_and_button() -> None:
    words = Catalogue({"Open": "開く", "Undo {}": "元に戻す: {}", "Line": "直線"})
    assert words.look_up("&Open…") == "開く(&O)…"
    assert words.look_up("Open (Ctrl+O)") == "開く (Ctrl+O)"
    assert words.look_up(" Open ") == " 開く "
    assert words.look_up("&Open\tDel") == "開く(&O)\tDel"
    assert words.look_up("Undo Line") == "元に戻す: 直線"
    assert words.look_up("Undo {x}") == "元に戻す: {x}"
    assert words.look_up("Close") is None
    assert words.look_up("") is None


def test_a_sentence_is_found_behind_its_place_and_choices_stay_as_they_are() -> None:
    words = Catalogue(
        {"{} is wrong{}{}; use {}": "{} は誤り{}{}。{}", "passes": "回", "It ends: so": "終わる", "a.b": "甲"}
    )
    assert words.look_up("f.toml:3: x is wrong; use pitch, passes") == "f.toml:3: x は誤り。pitch, passes"
    assert words.look_up("a.b: 7: It ends: so") == "a.b: 7: 終わる"
    assert words.look_up("passes is wrong!; use passes") == "回 は誤り!。回"
    assert words.look_up("f.toml:3: nobody knows") is None


def test_rows_of_problems_are_painted_in_the_language_that_is_spoken(qtbot) -> None:
    panel = PlacesPanel("problem", "N")
    qtbot.addWidget(panel)
    words = "1:7   Q2: no code in this block takes this word."
    panel.show_places("1 error", [ListedPlace(words, "", PlaceWeight.ERROR)])
    painted = []
    for code in ("ja", "en"):
        set_language(code)
        option = QStyleOptionViewItem()
        panel.list.itemDelegate().initStyleOption(option, panel.list.indexFromItem(panel.list.item(0)))
        painted.append(option.text)
    assert painted == ["1:7   Q2: このブロックのどのコードもこのワードを使いません。", words]


def test_what_the_catalogue_lacks_stays_english() -> None:
    set_language("ja")
    assert tr("Never heard of") == "Never heard of"
    assert tr("Fit") == "全体表示"
    assert catalogue("en").look_up("Fit") is None


def test_the_codes_of_the_choices() -> None:
    assert [code_of(choice) for choice in (Language.ENGLISH, Language.JAPANESE)] == ["en", "ja"]


LATIN = re.compile(r"[A-Za-z]{3,}")
JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
NOT_TRANSLATED = {
    "English",
    "NC (Ctrl+7)",
    "Fanuc",
    "Haas",
    "LinuxCNC",
    "Mach3",
    "grbl",
    "mm/min",
    "rpm",
    "dpi",
    "Esc",
    "UNC",
    "UNF",
}
"""Names of controls, units, keys and threads."""


def seen_texts(window: QWidget) -> set[str]:
    """What widgets that can be seen show or say of themselves."""
    found = set[str]()
    for widget in window.findChildren(QWidget):
        found |= {widget.toolTip(), widget.accessibleName()}
        if isinstance(widget, QLabel | QAbstractButton):
            found.add(widget.text())
        elif isinstance(widget, QComboBox):
            found |= {widget.itemText(at) for at in range(widget.count())}
        elif isinstance(widget, QLineEdit | QPlainTextEdit):
            found.add(widget.placeholderText())
    return found


def left_english(texts: set[str]) -> list[str]:
    words = {
        text: set(re.split(r"[\s(]", text)) | {text}
        for text in texts
        if LATIN.search(text) and not JAPANESE.search(text)
    }
    return sorted(text for text, parts in words.items() if not parts & NOT_TRANSLATED)


def test_nothing_of_the_window_is_left_in_english(japanese) -> None:
    window = japanese.window_
    for line in ("rect 0,0 60,40 round 5", "circle 30,20 8", "select all"):
        japanese.document.run(line)
    for page in window.side.tabs:
        window.side.show_page(page)
        window.grab()
    translate_all(window)
    assert left_english(seen_texts(window)) == []


@pytest.mark.parametrize("kind", TOOLS)
def test_every_tool_asks_in_japanese(kind) -> None:
    set_language("ja")
    tool = TOOLS[kind]()
    asked = (
        {tr(ask.prompt) for ask in tool.asks if ask}
        if isinstance(tool, PromptTool)
        else {tr(words) for words in tool.prompts}
    )
    assert left_english({tr(tool.prompt), *asked}) == []


def test_the_log_and_the_mouse_speak_japanese(qtbot, japanese) -> None:
    for line in ("line 0,0 10,0", "circle 5,5 2", "undo", "lime 1,1", "circle 5,5"):
        japanese.window_.command_line.entered.emit(line)
    log = japanese.window_.command_line.log
    qtbot.waitUntil(lambda: len(log.lines) == 5)
    shown = [
        log.model().data(log.model().index(row, 0), Qt.ItemDataRole.ToolTipRole).split("</p>")[1]
        for row in range(len(log.lines))
    ]
    assert [JAPANESE.search(text) is not None for text in shown] == [True] * 5, shown


@pytest.mark.parametrize(
    "line",
    [
        "line 0,0 9,0",
        "polyline 0,0 9,0 9,9",
        "arc 0,0 4,4 9,0",
        "circle 0,0 5",
        "polygon 6 0,0 5,0",
        "slot 0,0 9,0 2",
        "ellipse 0,0 9,0 3",
        "rect 0,0 9,9",
        "spline 0,0 4,4 9,0",
        'text 0,0 5 "Hi"',
        'text 0,0 5 "I"',
    ],
)
def test_what_is_drawn_is_answered_in_japanese(line: str) -> None:
    document = Document()
    document.run(line)
    set_language("ja")
    assert not re.search(r"[A-Za-z]{3}", tr(document.log[-1].reply)), document.log[-1].reply


@pytest.mark.parametrize("lines", ["1 line", "7 lines"])
@pytest.mark.parametrize("motions", ["1 motion", "7 motions"])
@pytest.mark.parametrize("found", ["", ", 1 error", ", 2 errors, 1 warning"])
def test_what_is_said_of_a_program_that_was_opened_is_japanese(lines: str, motions: str, found: str) -> None:
    set_language("ja")
    assert not re.search(r"[A-Za-z]{3}", tr(f"{lines}, {motions}{found}."))


@pytest.mark.parametrize(("surfaces", "tools", "families"), [(1, 2, 1), (5, 1, 3)])
def test_what_is_said_of_a_scene_that_was_opened_is_japanese(surfaces: int, tools: int, families: int) -> None:
    made_of = (counted(surfaces, "surface"), counted(tools, "tool"), counted(families, "family", "families"))
    set_language("ja")
    assert not re.search(r"[A-Za-z]{3}", tr(f"{made_of[0]}, {made_of[1]}, 1 of {made_of[2]} of passes switched on"))


def test_tools_of_the_library_are_told_in_japanese() -> None:
    set_language("ja")
    for tool in shipped_tools():
        for line in (*about_tool(tool, None).split("\n"), tool.label, f"T7 {tool.label}"):
            assert not re.search(r"[A-Za-z]{4}", tr(line)), line


def filters() -> set[str]:
    """Return every kind of file that a dialog of the window offers, as it is written there."""
    sources = (path.read_text("utf-8") for path in (Path(app.__file__).parent / "ui").rglob("*.py"))
    texts = (
        node.value
        for source in sources
        if "(*." in source or "(*)" in source
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and "\n" not in node.value
    )
    return {one for text in texts if "(*" in text for one in text.split(";;") if one[:1].isalpha()}


def test_kinds_of_files_are_offered_in_japanese() -> None:
    set_language("ja")
    offered, same_everywhere = filters(), {"GIF (*.gif)", "HTML (*.html)"}
    assert len(offered) > 10
    assert [one for one in sorted(offered - same_everywhere) if tr(one) == one] == []


@pytest.mark.parametrize(
    "name",
    ["Propose operations", "Change depth", "Change curves", "Drill this", "Contour outside this", "Move operation"],
)
def test_changes_are_named_in_japanese_where_they_are_undone(name: str) -> None:
    set_language("ja")
    assert not re.search(r"[A-Za-z]{3}", tr(name)) and tr(f"&Undo {name}") == f"元に戻す: {tr(name)}"


def test_history_and_undo_are_in_the_windows_language(japanese) -> None:
    japanese.document.change_job("Propose operations", replace(japanese.document.job, operations=()))
    history = japanese.window_.drawing_page.history.list
    shown = [history.itemDelegate().displayText(history.item(at).text(), QLocale()) for at in range(history.count())]
    assert not [text for text in shown if re.search(r"[A-Za-z]{3}", text)]
    assert tr(japanese.window_.actions_["undo"].text()) == "元に戻す: 工程を提案"


def test_about_is_in_the_windows_language(qtbot, japanese) -> None:
    show_about(japanese.window_)
    box = japanese.window_.findChild(QMessageBox)
    assert "線図から" in box.text() and "published" not in box.text()
    box.close()


def test_a_chosen_item_stays_chosen_when_its_name_changes(qtbot) -> None:
    box = QComboBox()
    qtbot.addWidget(box)
    box.addItems(["Climb", "Conventional"])
    box.setCurrentIndex(1)
    set_language("ja")
    translate_all(box)
    assert (box.currentText(), box.currentIndex()) == ("アップカット", 1)
    set_language("en")
    translate_all(box)
    assert box.currentText() == "Conventional"


def test_holes_for_numbers_let_sentences_be() -> None:
    words = Catalogue({"{n} of {n}": "{n} / {n}", "{}: {}": "{}: {}", "Arc": "円弧", "centre": "中心"})
    assert words.look_up("2 of 12") == "2 / 12"
    assert words.look_up("The end of the line") is None
    assert words.look_up("Arc: centre") == "円弧: 中心"


def test_sentences_are_looked_up_before_an_entry_swallows_them_and_lists_name_by_name():
    words = Catalogue(
        {
            "Found: {}.": "発見: {}。",
            "no gouge": "食込みなし",
            "Zoom in.": "拡大。",
            "Drill": "穴あけ",
            "Pocket": "ポケット",
        },
        {",": "、", "or": "または", "and": "と"},
    )
    assert words.look_up("Found: no gouge. Zoom in.") == "発見: 食込みなし。拡大。"
    assert words.look_up("Found: drill, pocket.") == "発見: 穴あけ、ポケット。"
    assert words.look_up("Found: drill, saw.") == "発見: drill, saw。", "half a list is none"
    assert words.look_up("Found: drill or pocket.") == "発見: 穴あけまたはポケット。"
    assert words.look_up("Found: pocket, drill and pocket.") == "発見: ポケット、穴あけとポケット。"
    assert words.look_up("Found: 'mm' or 'in'.") == "発見: 'mm' または 'in'。"
    assert words.look_up("Found: front and back.dxf.") == "発見: front and back.dxf。", "the name of a file is none"
    assert words.look_up("Found: drill or saw.") == "発見: drill or saw。"
    assert words.look_up("Found: .dxf, .svg or .draw.") == "発見: .dxf, .svg または .draw。"


@pytest.mark.parametrize(
    ("sorts", "japanese"),
    [
        ([LeftOutSort("TEXT", LeftOutReason.INVISIBLE)], "除いたもの: 2 TEXT (非表示)。"),
        (
            [LeftOutSort("circle", LeftOutReason.CLIPPED), LeftOutSort("path", LeftOutReason.INVISIBLE)],
            "除いたもの: 円 2 個 (切抜きの外), 2 path (非表示)。",
        ),
        (
            [LeftOutSort("POINT"), LeftOutSort("TEXT", LeftOutReason.AS_ASKED)],
            "除いたもの: 2 POINT, 2 TEXT (指定による)。",
        ),
    ],
)
def test_what_is_left_out_of_a_drawing_and_why_is_japanese_as_a_whole(sorts, japanese) -> None:
    (finding,) = all_left_out(Counter(dict.fromkeys(sorts, 2)))
    assert catalogue("ja").look_up(finding.text) == japanese


def test_every_reason_for_leaving_something_out_is_japanese() -> None:
    for reason in LeftOutReason:
        (finding,) = all_left_out(Counter({LeftOutSort("TEXT", reason): 1}))
        found = catalogue("ja").look_up(finding.text)
        assert found is not None and reason.value not in found, found


def test_the_badge_speaks_the_language_while_it_turns(qtbot, japanese):
    badge = japanese.window_.status.badge
    for _ in range(4):
        badge._advance()
        translate(badge)
        assert badge.text().endswith("計算中") and not re.search("[A-Za-z]", badge.text())
