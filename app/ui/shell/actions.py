"""Everything that menus, tool bars and keys can do: one table, one QAction each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from ...model.operation import OPERATION_KINDS
from ..framework.icons import icon
from ..framework.theme import Theme
from ..framework.view import views
from ..views.canvas.modes import CanvasTool
from ..views.canvas.tools import TOOLS


@dataclass(frozen=True, slots=True)
class Spec:
    """One action.

    Attributes:
        name: by which the window connects it. text: in the menu. key: shortcut.
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


SEPARATOR = Spec("", "")
MACHINE_THIS = "&Machine this"
_TOOLS = frozenset(f"tool_{tool.value}" for tool in (CanvasTool.SELECT, *TOOLS))

MENUS: tuple[tuple[str, tuple[Spec, ...]], ...] = (
    (
        "&File",
        (
            Spec("new", "&New", "Ctrl+N", "new"),
            Spec("open", "&Open…", "Ctrl+O", "open"),
            Spec("reading", "Readin&g options…"),
            Spec("sample", "Open sa&mple part"),
            Spec("scene_new", "New sce&ne"),
            Spec("scene_compound", "Figure 1: three surfaces", under="Sample scenes"),
            Spec("scene_spheres", "Two spheres on a plane", under="Sample scenes"),
            Spec("scene_torus", "Torus", under="Sample scenes"),
            Spec("scene_die", "Die, roughed and finished", under="Sample scenes"),
            SEPARATOR,
            Spec("save", "&Save", "Ctrl+S", "save"),
            Spec("save_as", "Save &as…", "Ctrl+Shift+S"),
            Spec("save_copy", "Save a &copy…"),
            Spec("backups", "&Keep a backup", checkable=True),
            SEPARATOR,
            Spec("export_drawing", "Export &drawing…", "Ctrl+Alt+E"),
            Spec("export", "&Export NC…", "Ctrl+E", "export"),
            Spec("frame", "Export &frame of the job…"),
            Spec("underlay", "Place p&icture to trace…"),
            Spec("plot", "&Print or plot…", "Ctrl+P"),
            SEPARATOR,
            Spec("quit", "&Quit", "Ctrl+Q"),
        ),
    ),
    (
        "&Edit",
        (
            Spec("undo", "&Undo", "Ctrl+Z", "undo"),
            Spec("redo", "&Redo", "Ctrl+Shift+Z", "redo"),
            SEPARATOR,
            Spec("delete", "&Delete", icon="delete", key_hint="Del"),
            Spec("select_all", "Select &all", "Ctrl+A"),
        ),
    ),
    (
        "&View",
        (
            SEPARATOR,
            Spec("fit", "&Fit", "Ctrl+0", "fit", key_hint="F; Home in Draw"),
            Spec("zoom_in", "Zoom &in", "Ctrl++", "zoom-in"),
            Spec("zoom_out", "Zoom &out", "Ctrl+-", "zoom-out"),
            Spec("cut_picture", "Save &picture of the cut…"),
            Spec("record", "Record the cut…"),
            SEPARATOR,
            Spec("snap", "&Snap to points", "F3", checkable=True),
            Spec("ortho", "Ort&ho", "F8", checkable=True),
            Spec("polar", "Po&lar rays", "Ctrl+F8", checkable=True),
            Spec("grid", "Snap to &grid", "F9", checkable=True),
            SEPARATOR,
            Spec("properties", "P&roperties", "Ctrl+I"),
            Spec("layers", "La&yers", "F11"),
            Spec("history", "&History", "Ctrl+H"),
            Spec("clean_up", "Cl&ean up"),
            SEPARATOR,
            Spec("log", "L&og", "F2", checkable=True),
            Spec("command", "&Command line", "Ctrl+L"),
            Spec("text", "Te&xt of the drawing", "F12"),
            Spec("palette", "Command palette…", "Ctrl+Shift+Space"),
            SEPARATOR,
            Spec("underlay_shown", "Picture to t&race", checkable=True, under="Pict&ure"),
            Spec("underlay_scale", "Scale picture by two points", under="Pict&ure"),
            Spec("underlay_move", "Move picture", under="Pict&ure"),
            Spec("underlay_turn", "Straighten picture", under="Pict&ure"),
            Spec("underlay_remove", "Remove picture", under="Pict&ure"),
            Spec("units_mm", "&Millimetres", group="units", checkable=True, under="Uni&ts"),
            Spec("units_inch", "In&ches", group="units", checkable=True, under="Uni&ts"),
            Spec("theme_system", "Colours of the s&ystem", group="theme", checkable=True, under="Colours"),
            Spec("theme_light", "&Light", group="theme", checkable=True, under="Colours"),
            Spec("theme_dark", "D&ark", group="theme", checkable=True, under="Colours"),
            Spec("language_system", "Language of the system", group="language", checkable=True, under="Language"),
            Spec("language_en", "English", group="language", checkable=True, under="Language"),
            Spec("language_ja", "日本語", group="language", checkable=True, under="Language"),
        ),
    ),
    (
        "&Draw",
        (
            Spec("tool_select", "&Select", "Ctrl+Shift+V", icon="select", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_line", "&Line", "Ctrl+Shift+L", icon="line", group="tool", checkable=True),
            Spec("tool_polyline", "&Polyline", "Ctrl+Shift+P", icon="polyline", group="tool", checkable=True),
            SEPARATOR,
            Spec(
                "tool_arc_three", "Arc: &three points", "Ctrl+Shift+T", icon="arc-three", group="tool", checkable=True
            ),
            Spec(
                "tool_arc_centre",
                "&Arc: start, end, centre",
                "Ctrl+Shift+A",
                icon="arc-centre",
                group="tool",
                checkable=True,
            ),
            Spec("tool_arc_radius", "Arc: start, end, ra&dius", icon="arc-radius", group="tool", checkable=True),
            Spec("tool_arc_on", "Arc: &onward from the last curve", icon="arc-on", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_circle", "&Circle", "Ctrl+Shift+C", icon="circle", group="tool", checkable=True),
            Spec("tool_circle_two", "Circle: ends of a d&iameter", icon="circle-two", group="tool", checkable=True),
            Spec("tool_circle_three", "Circle: t&hree points", icon="circle-three", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_rectangle", "&Rectangle", "Ctrl+Shift+R", icon="rectangle", group="tool", checkable=True),
            Spec(
                "tool_rectangle_round",
                "Rectangle with ro&und corners",
                icon="rectangle-round",
                group="tool",
                checkable=True,
            ),
            Spec("tool_polygon", "Pol&ygon", icon="polygon", key_hint="pg", group="tool", checkable=True),
            Spec("tool_slot", "Slo&t", icon="slot", key_hint="sl", group="tool", checkable=True),
            Spec("tool_ellipse", "&Ellipse", icon="ellipse", key_hint="el", group="tool", checkable=True),
            Spec("tool_spline", "Splin&e", icon="spline", key_hint="sp", group="tool", checkable=True),
            Spec("tool_text", "Te&xt", icon="text", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_point", "Poi&nt", icon="point", group="tool", checkable=True),
            Spec(
                "tool_guide", "Construction line (&guide)", "Ctrl+Shift+G", icon="guide", group="tool", checkable=True
            ),
            Spec("tool_dimension", "Di&mension", "Ctrl+Shift+D", icon="dimension", group="tool", checkable=True),
        ),
    ),
    (
        "&Modify",
        (
            Spec("tool_move", "&Move", "Ctrl+Shift+M", icon="move", group="tool", checkable=True),
            Spec("tool_copy", "&Copy", "Ctrl+Shift+K", icon="duplicate", group="tool", checkable=True),
            Spec("tool_rotate", "&Rotate", "Ctrl+Shift+U", icon="rotate", group="tool", checkable=True),
            Spec("tool_scale", "&Scale", icon="scale", group="tool", checkable=True),
            Spec("tool_mirror", "M&irror", "Ctrl+Shift+I", icon="mirror", group="tool", checkable=True),
            Spec("tool_array", "&Array: columns and rows", icon="array", group="tool", checkable=True),
            Spec("tool_array_polar", "Array: round a &centre", icon="array-polar", group="tool", checkable=True),
            Spec("tool_offset", "&Offset", "Ctrl+Shift+W", icon="offset", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_trim", "&Trim", "Ctrl+Shift+X", icon="trim", group="tool", checkable=True),
            Spec("tool_extend", "&Extend", icon="extend", key_hint="ex", group="tool", checkable=True),
            Spec("tool_break", "&Break", icon="break", key_hint="br", group="tool", checkable=True),
            Spec("tool_fillet", "&Fillet", "Ctrl+Shift+B", icon="fillet", group="tool", checkable=True),
            Spec("tool_chamfer", "C&hamfer", "Ctrl+Shift+H", icon="chamfer", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_join", "&Join", "Ctrl+Shift+J", icon="join", group="tool", checkable=True),
            Spec("tool_explode", "Ex&plode", icon="explode", group="tool", checkable=True),
            Spec("tool_reverse", "Re&verse", icon="reverse", group="tool", checkable=True),
            SEPARATOR,
            Spec("tool_measure", "Meas&ure", "Ctrl+Shift+Y", icon="measure", group="tool", checkable=True),
        ),
    ),
    (
        "&Job",
        (
            Spec("job_properties", "&Stock and origin", "Ctrl+J"),
            SEPARATOR,
            Spec("add_tool", "Add &tool", "Ctrl+T"),
            Spec("tool_library", "Tool &library", "F6"),
            Spec("which_tool", "&Which tool?", "Shift+F6"),
            Spec("import_tools", "&Import tools…"),
            Spec("export_tools", "&Export tools…"),
            SEPARATOR,
            Spec("add_pocket", "Add &pocket"),
            Spec("add_rest", "Add &rest machining"),
            Spec("add_contour", "Add &contour"),
            Spec("add_drill", "Add &drilling"),
            SEPARATOR,
            Spec("machine_pocket", "&Pocket", under=MACHINE_THIS),
            Spec("machine_outside", "Contour &outside", under=MACHINE_THIS),
            Spec("machine_inside", "Contour &inside", under=MACHINE_THIS),
            Spec("machine_on", "Contour on &line", under=MACHINE_THIS),
            Spec("machine_drill", "&Drill", under=MACHINE_THIS),
            Spec("machine_engrave", "&Engrave", under=MACHINE_THIS),
        ),
    ),
    (
        "&Compute",
        (
            Spec("compute", "&Compute", "F5", "compute"),
            Spec("cancel", "C&ancel", "Shift+F5", "cancel"),
            Spec("propose", "Pr&opose operations", "Ctrl+F5"),
            Spec("propose_1986", "Operations as in 1&986"),
            Spec("scene_nc", "Show the scene's NC &program"),
            Spec("scene_cut", "Show the scene's c&ut"),
            Spec("stages_again", "Compute the &stages"),
            SEPARATOR,
            Spec(
                "memory_quarter",
                "A &quarter of the machine's",
                group="memory",
                checkable=True,
                under="&Memory of a job",
            ),
            Spec("memory_half", "&Half of the machine's", group="memory", checkable=True, under="&Memory of a job"),
            Spec(
                "memory_most",
                "&Three quarters of the machine's",
                group="memory",
                checkable=True,
                under="&Memory of a job",
            ),
            Spec("findings", "&Findings", "Ctrl+Shift+F"),
        ),
    ),
    (
        "&NC",
        (
            Spec("nc_open", "&Open program…", "Ctrl+Shift+O"),
            Spec("nc_back", "&Back to the job's program"),
            Spec("nc_save", "&Save text as…", "Ctrl+Alt+S"),
            SEPARATOR,
            Spec("nc_find", "&Find…", "Ctrl+F", "find"),
            Spec("nc_find_next", "Find &next", key_hint="F3 in NC"),
            Spec("nc_find_before", "Find &previous", key_hint="Shift+F3 in NC"),
            Spec("nc_line", "&Go to line…", "Ctrl+G"),
            SEPARATOR,
            Spec("nc_problem", "Next pro&blem", "F4"),
            Spec("nc_problem_before", "Previous problem", "Shift+F4"),
            SEPARATOR,
            Spec("nc_compare", "&Compare with…", "Ctrl+D"),
            Spec("nc_difference", "Next &difference", "F7"),
            Spec("nc_difference_before", "Previous difference", "Shift+F7"),
            Spec("nc_compare_end", "&End comparing"),
            SEPARATOR,
            Spec("nc_cut", "Show the c&ut", "Ctrl+K"),
            Spec("nc_restart", "&Restart from this line…", "Ctrl+R"),
            Spec("nc_frame", "Show the fra&me of the job"),
            Spec("curves_smooth", "&Smooth the program", "Ctrl+Alt+C"),
            SEPARATOR,
            Spec("nc_xy", "Seen from above: &XY", "Alt+1"),
            Spec("nc_xz", "Seen from the front: X&Z", "Alt+2"),
            Spec("nc_yz", "Seen from the side: &YZ", "Alt+3"),
        ),
    ),
    (
        "&Help",
        (
            Spec("help_language", "Shape &language"),
            Spec("manual", "&Manual"),
            Spec("keys", "&Keys", "F1"),
            Spec("what_is_this", "&What is this?", "Shift+F1"),
            Spec("tour", "&Tour"),
            Spec("session_1986", "A 1986 &session"),
            Spec("about", "&About Hitofude"),
        ),
    ),
)


def menus() -> Iterator[tuple[str, tuple[Spec, ...]]]:
    """Yield the menus, with every view and every kind of operation that is registered."""
    for title, specs in MENUS:
        if title == "&View":
            specs = (*(Spec(view.value, view.text, view.key, group="view", checkable=True) for view in views()), *specs)
        if title == "&Job":
            listed = {spec.name for spec in specs}
            others = (Spec(f"add_{word}", f"Add {word}") for word in OPERATION_KINDS)
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
        self.specs: dict[str, Spec] = {}
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

    def _add(self, spec: Spec, window: QWidget) -> None:
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
        """Return an action's key as text, or ""."""
        return self.by_name[name].shortcut().toString()

    def set_key(self, name: str, key: str) -> None:
        """Give an action a key, "" = none, and say so in its tip."""
        spec, action = self.specs[name], self.by_name[name]
        action.setShortcut(QKeySequence(key))
        shown = key or spec.key_hint
        action.setToolTip(f"{plain(spec.text)} ({shown})" if shown else plain(spec.text))


def plain(text: str) -> str:
    """Return a menu's text without the letter to press and without dots."""
    return text.replace("&", "").rstrip("…")
