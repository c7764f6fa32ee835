"""Everything that menus, tool bars and keys can do: one table, one QAction each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from ....model.operation_kinds import OPERATION_KINDS
from ...framework.icons import icon
from ...framework.theme import Theme
from ...framework.view import views
from ...views.canvas.modes import CanvasTool
from ...views.canvas.tool_table import TOOLS


@dataclass(frozen=True, slots=True)
class ActionSpec:
    """One action.

    Attributes:
        name: by which the window connects it. text: in the menu. key: shortcut, or several, "; " between them.
        key_hint: shown like a shortcut, but the canvas itself listens to the key.
        group: of checkable actions of which one is on; "" with `checkable` for a switch of its own.
        under: title of the menu within the menu that holds it, or "".
    """

    name: str
    text: str
    key: str = ""
    icon: str = ""
    key_hint: str = ""
    group: str = ""
    checkable: bool = False
    under: str = ""


SEPARATOR = ActionSpec("", "")
MACHINE_THIS = "&Machine this"
_TOOLS = frozenset(f"tool_{tool.value}" for tool in (CanvasTool.SELECT, *TOOLS))

MENUS: tuple[tuple[str, tuple[ActionSpec, ...]], ...] = (
    (
        "&File",
        (
            ActionSpec("new", "&New", "Ctrl+N", "new"),
            ActionSpec("open", "&Open…", "Ctrl+O", "open"),
            ActionSpec("reading", "Readin&g options…"),
            ActionSpec("sample", "Open sa&mple part"),
            ActionSpec("scene_new", "New sce&ne"),
            ActionSpec("scene_compound", "Figure 1: three surfaces", under="Sample scenes"),
            ActionSpec("scene_spheres", "Two spheres on a plane", under="Sample scenes"),
            ActionSpec("scene_torus", "Torus", under="Sample scenes"),
            ActionSpec("scene_die", "Die, roughed and finished", under="Sample scenes"),
            ActionSpec("program_facets", "Half an ellipse as facets", under="Sample programs"),
            ActionSpec("program_points", "Points of an S", under="Sample programs"),
            ActionSpec("program_raster", "Passes over a polyhedron", under="Sample programs"),
            ActionSpec("program_valley", "Passes over two surfaces", under="Sample programs"),
            SEPARATOR,
            ActionSpec("save", "&Save", "Ctrl+S", "save"),
            ActionSpec("save_as", "Save &as…", "Ctrl+Shift+S"),
            ActionSpec("save_copy", "Save a &copy…"),
            ActionSpec("backups", "&Keep a backup", checkable=True),
            SEPARATOR,
            ActionSpec("export_drawing", "Export &drawing…", "Ctrl+Alt+E"),
            ActionSpec("export", "&Export NC…", "Ctrl+E", "export"),
            ActionSpec("sheet", "S&heet for the machine…"),
            ActionSpec("inlay", "&Inlay: pocket and plug…"),
            ActionSpec("frame", "Export &frame of the job…"),
            ActionSpec("underlay", "Place p&icture to trace…"),
            ActionSpec("plot", "&Print or plot…", "Ctrl+P"),
            SEPARATOR,
            ActionSpec("quit", "&Quit", "Ctrl+Q"),
        ),
    ),
    (
        "&Edit",
        (
            ActionSpec("undo", "&Undo", "Ctrl+Z", "undo"),
            ActionSpec("redo", "&Redo", "Ctrl+Shift+Z; Ctrl+Y", "redo"),
            SEPARATOR,
            ActionSpec("delete", "&Delete", icon="delete", key_hint="Del"),
            ActionSpec("select_all", "Select &all", "Ctrl+A"),
        ),
    ),
    (
        "&View",
        (
            SEPARATOR,
            ActionSpec("fit", "&Fit", "Ctrl+0", "fit", key_hint="F; Home in Draw"),
            ActionSpec("zoom_in", "Zoom &in", "Ctrl++; Ctrl+=", "zoom-in"),
            ActionSpec("zoom_out", "Zoom &out", "Ctrl+-", "zoom-out"),
            ActionSpec("cut_picture", "Save &picture of the cut…"),
            ActionSpec("record", "Record the cut…"),
            SEPARATOR,
            ActionSpec("snap", "&Snap to points", "F3", checkable=True),
            ActionSpec("ortho", "Ort&ho", "F8", checkable=True),
            ActionSpec("polar", "Po&lar rays", "Ctrl+F8", checkable=True),
            ActionSpec("grid", "Snap to &grid", "F9", checkable=True),
            SEPARATOR,
            ActionSpec("properties", "P&roperties", "Ctrl+I"),
            ActionSpec("layers", "La&yers", "F11"),
            ActionSpec("history", "&History", "Ctrl+H"),
            ActionSpec("clean_up", "Cl&ean up"),
            SEPARATOR,
            ActionSpec("log", "L&og", "F2", checkable=True),
            ActionSpec("command", "&Command line", "Ctrl+L"),
            ActionSpec("text", "Te&xt of the drawing", "F12"),
            ActionSpec("palette", "Command palette…", "Ctrl+Shift+Space"),
            SEPARATOR,
            ActionSpec("underlay_shown", "Picture to t&race", checkable=True, under="Pict&ure"),
            ActionSpec("underlay_scale", "Scale picture by two points", under="Pict&ure"),
            ActionSpec("underlay_move", "Move picture", under="Pict&ure"),
            ActionSpec("underlay_turn", "Straighten picture", under="Pict&ure"),
            ActionSpec("underlay_remove", "Remove picture", under="Pict&ure"),
            ActionSpec("units_mm", "&Millimetres", group="units", checkable=True, under="Uni&ts"),
            ActionSpec("units_inch", "In&ches", group="units", checkable=True, under="Uni&ts"),
            ActionSpec("theme_system", "Colours of the s&ystem", group="theme", checkable=True, under="Colours"),
            ActionSpec("theme_light", "&Light", group="theme", checkable=True, under="Colours"),
            ActionSpec("theme_dark", "D&ark", group="theme", checkable=True, under="Colours"),
            ActionSpec("language_system", "Language of the system", group="language", checkable=True, under="Language"),
            ActionSpec("language_en", "English", group="language", checkable=True, under="Language"),
            ActionSpec("language_ja", "日本語", group="language", checkable=True, under="Language"),
        ),
    ),
    (
        "&Draw",
        (
            ActionSpec("tool_select", "&Select", "Ctrl+Shift+V", icon="select", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_line", "&Line", "Ctrl+Shift+L", icon="line", group="tool", checkable=True),
            ActionSpec("tool_polyline", "&Polyline", "Ctrl+Shift+P", icon="polyline", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec(
                "tool_arc_three", "Arc: &three points", "Ctrl+Shift+T", icon="arc-three", group="tool", checkable=True
            ),
            ActionSpec(
                "tool_arc_centre",
                "&Arc: start, end, centre",
                "Ctrl+Shift+A",
                icon="arc-centre",
                group="tool",
                checkable=True,
            ),
            ActionSpec("tool_arc_radius", "Arc: start, end, ra&dius", icon="arc-radius", group="tool", checkable=True),
            ActionSpec("tool_arc_on", "Arc: &onward from the last curve", icon="arc-on", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_circle", "&Circle", "Ctrl+Shift+C", icon="circle", group="tool", checkable=True),
            ActionSpec(
                "tool_circle_two", "Circle: ends of a d&iameter", icon="circle-two", group="tool", checkable=True
            ),
            ActionSpec("tool_circle_three", "Circle: t&hree points", icon="circle-three", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_rectangle", "&Rectangle", "Ctrl+Shift+R", icon="rectangle", group="tool", checkable=True),
            ActionSpec(
                "tool_rectangle_round",
                "Rectangle with ro&und corners",
                icon="rectangle-round",
                group="tool",
                checkable=True,
            ),
            ActionSpec("tool_polygon", "Pol&ygon", icon="polygon", key_hint="pg", group="tool", checkable=True),
            ActionSpec("tool_slot", "Slo&t", icon="slot", key_hint="sl", group="tool", checkable=True),
            ActionSpec("tool_ellipse", "&Ellipse", icon="ellipse", key_hint="el", group="tool", checkable=True),
            ActionSpec("tool_spline", "Splin&e", icon="spline", key_hint="sp", group="tool", checkable=True),
            ActionSpec("tool_text", "Te&xt", icon="text", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_point", "Poi&nt", icon="point", group="tool", checkable=True),
            ActionSpec(
                "tool_guide", "Construction line (&guide)", "Ctrl+Shift+G", icon="guide", group="tool", checkable=True
            ),
            ActionSpec("tool_dimension", "Di&mension", "Ctrl+Shift+D", icon="dimension", group="tool", checkable=True),
        ),
    ),
    (
        "&Modify",
        (
            ActionSpec("tool_move", "&Move", "Ctrl+Shift+M", icon="move", group="tool", checkable=True),
            ActionSpec("tool_copy", "&Copy", "Ctrl+Shift+K", icon="duplicate", group="tool", checkable=True),
            ActionSpec("tool_rotate", "&Rotate", "Ctrl+Shift+U", icon="rotate", group="tool", checkable=True),
            ActionSpec("tool_scale", "&Scale", icon="scale", group="tool", checkable=True),
            ActionSpec("tool_mirror", "M&irror", "Ctrl+Shift+I", icon="mirror", group="tool", checkable=True),
            ActionSpec("tool_array", "&Array: columns and rows", icon="array", group="tool", checkable=True),
            ActionSpec("tool_array_polar", "Array: round a &centre", icon="array-polar", group="tool", checkable=True),
            ActionSpec("tool_offset", "&Offset", "Ctrl+Shift+W", icon="offset", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_trim", "&Trim", "Ctrl+Shift+X", icon="trim", group="tool", checkable=True),
            ActionSpec("tool_extend", "&Extend", icon="extend", key_hint="ex", group="tool", checkable=True),
            ActionSpec("tool_break", "&Break", icon="break", key_hint="br", group="tool", checkable=True),
            ActionSpec("tool_fillet", "&Fillet", "Ctrl+Shift+B", icon="fillet", group="tool", checkable=True),
            ActionSpec("tool_chamfer", "C&hamfer", "Ctrl+Shift+H", icon="chamfer", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_join", "&Join", "Ctrl+Shift+J", icon="join", group="tool", checkable=True),
            ActionSpec("tool_explode", "Ex&plode", icon="explode", group="tool", checkable=True),
            ActionSpec("tool_reverse", "Re&verse", icon="reverse", group="tool", checkable=True),
            SEPARATOR,
            ActionSpec("tool_measure", "Meas&ure", "Ctrl+Shift+Y", icon="measure", group="tool", checkable=True),
        ),
    ),
    (
        "&Job",
        (
            ActionSpec("job_properties", "&Stock and origin", "Ctrl+J"),
            SEPARATOR,
            ActionSpec("add_tool", "Add &tool", "Ctrl+T"),
            ActionSpec("tool_library", "Tool &library", "F6"),
            ActionSpec("which_tool", "&Which tool?", "Shift+F6"),
            ActionSpec("import_tools", "&Import tools…"),
            ActionSpec("export_tools", "&Export tools…"),
            SEPARATOR,
            ActionSpec("machine_pocket", "&Pocket", under=MACHINE_THIS),
            ActionSpec("machine_outside", "Contour &outside", under=MACHINE_THIS),
            ActionSpec("machine_inside", "Contour &inside", under=MACHINE_THIS),
            ActionSpec("machine_on", "Contour on &line", under=MACHINE_THIS),
            ActionSpec("machine_slot", "Slo&t", under=MACHINE_THIS),
            ActionSpec("machine_drill", "&Drill", under=MACHINE_THIS),
            ActionSpec("machine_bore", "&Bore", under=MACHINE_THIS),
            ActionSpec("machine_countersink", "Counter&sink", under=MACHINE_THIS),
            ActionSpec("machine_chamfer", "Cha&mfer", under=MACHINE_THIS),
            ActionSpec("machine_engrave", "&Engrave", under=MACHINE_THIS),
            ActionSpec("machine_vcarve", "&V-carve", under=MACHINE_THIS),
            SEPARATOR,
            ActionSpec("add_pocket", "Add &pocket"),
            ActionSpec("add_rest", "Add &rest machining"),
            ActionSpec("add_contour", "Add &contour"),
            ActionSpec("add_drill", "Add &drilling"),
        ),
    ),
    (
        "&Compute",
        (
            ActionSpec("compute", "&Compute", "F5", "compute"),
            ActionSpec("cancel", "C&ancel", "Shift+F5", "cancel"),
            ActionSpec("propose", "Pr&opose operations", "Ctrl+F5"),
            ActionSpec("propose_1986", "Operations as in 1&986"),
            ActionSpec("apply_template", "Apply &template…"),
            ActionSpec("drawn_depths", "&Depths from the drawing"),
            ActionSpec("scene_nc", "Show the scene's NC &program"),
            ActionSpec("scene_cut", "Show the scene's c&ut"),
            ActionSpec("stages_again", "Compute the &stages"),
            SEPARATOR,
            ActionSpec(
                "memory_quarter",
                "A &quarter of the machine's",
                group="memory",
                checkable=True,
                under="&Memory of a job",
            ),
            ActionSpec(
                "memory_half", "&Half of the machine's", group="memory", checkable=True, under="&Memory of a job"
            ),
            ActionSpec(
                "memory_most",
                "&Three quarters of the machine's",
                group="memory",
                checkable=True,
                under="&Memory of a job",
            ),
            ActionSpec("findings", "&Findings", "Ctrl+Shift+F"),
        ),
    ),
    (
        "&NC",
        (
            ActionSpec("nc_open", "&Open program…", "Ctrl+Shift+O"),
            ActionSpec("nc_back", "&Back to the job's program"),
            ActionSpec("nc_save", "&Save text as…", "Ctrl+Alt+S"),
            SEPARATOR,
            ActionSpec("nc_find", "&Find…", "Ctrl+F", "find"),
            ActionSpec("nc_find_next", "Find &next", key_hint="F3 in NC"),
            ActionSpec("nc_find_before", "Find &previous", key_hint="Shift+F3 in NC"),
            ActionSpec("nc_line", "&Go to line…", "Ctrl+G"),
            SEPARATOR,
            ActionSpec("nc_problem", "Next pro&blem", "F4"),
            ActionSpec("nc_problem_before", "Previous problem", "Shift+F4"),
            SEPARATOR,
            ActionSpec("nc_compare", "&Compare with…", "Ctrl+D"),
            ActionSpec("nc_difference", "Next &difference", "F7"),
            ActionSpec("nc_difference_before", "Previous difference", "Shift+F7"),
            ActionSpec("nc_compare_end", "&End comparing"),
            SEPARATOR,
            ActionSpec("nc_cut", "Show the c&ut", "Ctrl+K"),
            ActionSpec("nc_restart", "&Restart from this line…", "Ctrl+R"),
            ActionSpec("nc_frame", "Show the fra&me of the job"),
            ActionSpec("curves_smooth", "&Smooth the program", "Ctrl+Alt+C"),
            SEPARATOR,
            ActionSpec("nc_xy", "Seen from above: &XY", "Alt+1"),
            ActionSpec("nc_xz", "Seen from the front: X&Z", "Alt+2"),
            ActionSpec("nc_yz", "Seen from the side: &YZ", "Alt+3"),
        ),
    ),
    (
        "&Help",
        (
            ActionSpec("manual", "&Manual", "F1"),
            ActionSpec("help_language", "Shape &language"),
            ActionSpec("five_texts", "The &five texts"),
            ActionSpec("keys", "&Keys", "Ctrl+F1"),
            ActionSpec("what_is_this", "&What is this?", "Shift+F1"),
            ActionSpec("tour", "&Tour"),
            ActionSpec("session_1986", "A 1986 &session"),
            ActionSpec("about", "&About Hitofude"),
        ),
    ),
)


def menus() -> Iterator[tuple[str, tuple[ActionSpec, ...]]]:
    """Yield the menus, with every view and every kind of operation that is registered."""
    for title, specs in MENUS:
        if title == "&View":
            specs = (
                *(ActionSpec(view.value, view.text, view.key, group="view", checkable=True) for view in views()),
                *specs,
            )
        if title == "&Job":
            listed = {spec.name for spec in specs}
            others = (ActionSpec(f"add_{word}", f"Add {word}") for word in OPERATION_KINDS)
            specs = (*specs, *(spec for spec in others if spec.name not in listed))
        yield title, specs


class Actions:
    """The window's actions by name.

    Attributes:
        recent: the menu of files that were opened lately; whoever opens files fills it.
        specs, menu_of: row of the table and title of the menu of each action, by name.
    """

    def __init__(self, window: QWidget) -> None:
        self.recent = QMenu("Open &recent", window)
        self.by_name: dict[str, QAction] = {}
        self.specs: dict[str, ActionSpec] = {}
        self.menu_of: dict[str, str] = {}
        self._icons: dict[str, str] = {}
        self._groups: dict[str, QActionGroup] = {}
        for title, specs in menus():
            for spec in specs:
                if spec is not SEPARATOR:
                    self.specs[spec.name], self.menu_of[spec.name] = spec, title
                    self._add(spec, window)

    def __getitem__(self, name: str) -> QAction:
        return self.by_name[name]

    def fill(self, bar: QMenuBar) -> None:
        """Put the menus in the menu bar."""
        for title, specs in menus():
            menu: QMenu = bar.addMenu(title)
            under: dict[str, QMenu] = {}
            for spec in specs:
                if spec is SEPARATOR:
                    menu.addSeparator()
                elif spec.under:
                    if spec.under not in under:
                        under[spec.under] = menu.addMenu(spec.under)
                    under[spec.under].addAction(self.by_name[spec.name])
                else:
                    menu.addAction(self.by_name[spec.name])
                if spec.name == "open":
                    menu.addMenu(self.recent)

    def set_theme(self, theme: Theme) -> None:
        """Draw every icon anew."""
        for name, picture in self._icons.items():
            colour = theme.accent_ink if name == "compute" else None
            self.by_name[name].setIcon(icon(picture, theme, colour))

    def _add(self, spec: ActionSpec, window: QWidget) -> None:
        hint = f"\t{spec.key_hint}" if spec.key_hint and not spec.key else ""
        action = QAction(spec.text + hint, window)
        action.setObjectName(spec.name)
        action.setCheckable(spec.checkable)
        action.setVisible(spec.group != "tool" or spec.name in _TOOLS)
        action.setIconVisibleInMenu(False)
        if spec.icon:
            self._icons[spec.name] = spec.icon
        if spec.group:
            self._groups.setdefault(spec.group, QActionGroup(window)).addAction(action)
        window.addAction(action)
        self.by_name[spec.name] = action
        self.set_key(spec.name, spec.key)

    def key(self, name: str) -> str:
        """Return an action's keys as text, "; " between them, or ""."""
        return QKeySequence.listToString(self.by_name[name].shortcuts())

    def set_key(self, name: str, key: str) -> None:
        """Give an action its keys, "" = none, and say the first one in its tip."""
        spec, action = self.specs[name], self.by_name[name]
        action.setShortcuts(QKeySequence.listFromString(key))
        shown = action.shortcut().toString() or spec.key_hint
        action.setToolTip(f"{plain(spec.text)} ({shown})" if shown else plain(spec.text))


def plain(text: str) -> str:
    """Return a menu's text without the letter to press and without dots."""
    return text.replace("&", "").rstrip("…")
