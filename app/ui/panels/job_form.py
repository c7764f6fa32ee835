"""The form of the job: stock, origin, heights, post, copies, keep-out areas."""

from __future__ import annotations

from dataclasses import asdict, replace

from ...gcode.posts import post_titles
from ...model.job import LARGEST_JOIN, Copies, Job, OriginXY, OriginZ
from ...model.operation import Order
from ...model.part import Units
from ..framework.fields import ChoiceField, ListField, NumberSpec, TextField
from ..framework.form import FormSection
from . import parameter_sketches
from .changes import with_order
from .sketch import SketchWidget


class JobForm(FormSection):
    """Stock, origin, heights, how drawings are joined, post and units of the NC text."""

    def __init__(self) -> None:
        super().__init__("Stock and origin")
        self.margin = self.add_number(
            NumberSpec(
                "Stock margin", low=0, high=10_000, tip="How far the stock reaches beyond the part on every side."
            ),
            lambda job, v: replace(job, stock=replace(job.stock, margin=v)),
        )
        self.thickness = self.add_number(
            NumberSpec("Thickness", low=0.001, high=10_000, tip="Height of the stock; Z 0 is its top."),
            lambda job, v: replace(job, stock=replace(job.stock, thickness=v)),
        )
        self.above = self.add_number(
            NumberSpec(
                "Above Z 0", low=0, high=10_000, tip="What more of the stock stands above Z 0, to be faced off."
            ),
            lambda job, v: replace(job, stock=replace(job.stock, above=v)),
        )
        self.origin_xy = ListField("Origin XY", [(o, o.value.capitalize()) for o in OriginXY])
        self.add_choice("Origin XY", self.origin_xy, lambda job, v: replace(job, origin_xy=OriginXY(v)))
        self.origin_z = ListField("Origin Z", [(o, o.value.capitalize()) for o in OriginZ])
        self.add_choice("Origin Z", self.origin_z, lambda job, v: replace(job, origin_z=OriginZ(v)))
        self.safe_z = self.add_number(
            NumberSpec(
                "Safe Z",
                low=0.001,
                high=10_000,
                tip="Clearance height above the stock's top; rapids in the plane go there.",
            ),
            lambda job, v: replace(job, safe_z=v, retract_z=min(job.retract_z, v)),
        )
        self.join = self.add_number(
            NumberSpec(
                "Join tolerance", low=0, high=LARGEST_JOIN, tip="Loose ends of the drawing nearer than this are joined."
            ),
            lambda job, v: replace(job, join_tolerance=v),
        )
        self.order = ChoiceField(
            "Cutting order", [(Order.POCKET_FIRST, "As listed"), (Order.PATENT_1986, "Contours first")]
        )
        self.add_choice("Order", self.order, lambda job, v: with_order(job, Order(v)))
        self._posts = post_titles()
        self.post = ListField("Post", list(self._posts.items()))
        self.add_choice("Post", self.post, lambda job, v: replace(job, post=str(v)))
        self.units = ChoiceField("NC units", [(Units.MM, "mm"), (Units.INCH, "inch")])
        self.add_choice("NC units", self.units, lambda job, v: replace(job, out_units=Units(v)))
        self._size: tuple[float, float] | None = None
        self._add_copies()
        self._add_clamps()
        self._add_notes()

    def _add_copies(self) -> None:
        self.copies_group = self.begin_group("Copies")
        self.columns = self.add_number(
            NumberSpec("Columns", "", 1, 1000, 0, False, "How many along X."),
            lambda job, v: self._copied(job, columns=v),
        )
        self.rows_of = self.add_number(
            NumberSpec("Rows", "", 1, 1000, 0, False, "How many along Y."), lambda job, v: self._copied(job, rows=v)
        )
        tip = "From one copy to the next, same point to same point."
        self.dx = self.add_number(NumberSpec("Every X", low=-99_999, tip=tip), lambda job, v: self._copied(job, dx=v))
        self.dy = self.add_number(NumberSpec("Every Y", low=-99_999, tip=tip), lambda job, v: self._copied(job, dy=v))
        self.copies_picture = SketchWidget(parameter_sketches.copies, "The part in a grid")
        self.add_picture(self.copies_picture)

    def _add_clamps(self) -> None:
        self.clamps_group = self.begin_group("Keep-out areas")
        self.clamps = ListField("Layer", [])
        self.add_choice(
            "Keep-out layer", self.clamps, lambda job, v: replace(job, keep_out_layers=(str(v),) if v else ())
        )
        self.clamp_height = self.add_number(
            NumberSpec("Height", low=0, high=10_000, tip="Of clamps above the stock's top; rapids go over them."),
            lambda job, v: replace(job, keep_out_height=v),
        )

    def _add_notes(self) -> None:
        self.notes_group = self.begin_group("On the sheet")
        self.clamping = TextField("Clamping", "How the stock is held, as the sheet for the machine shall say it.")
        self.zero = TextField("Zero", "How the zero is set, as the sheet for the machine shall say it.")
        self.add_choice("Clamping", self.clamping, lambda job, v: replace(job, clamping_note=str(v)))
        self.add_choice("Zero", self.zero, lambda job, v: replace(job, zero_note=str(v)))

    def _copied(self, job: Job, **values: float) -> Job:
        """Return the job with other copies; a spacing that is yet missing leaves room for two tools between them."""
        asked: dict[str, float] = {**asdict(job.copies), **values}
        width, height = self._size or (0.0, 0.0)
        room = 2 * max((tool.diameter for tool in job.tools), default=0.0)
        columns, rows = int(asked["columns"]), int(asked["rows"])
        dx = asked["dx"] if asked["dx"] or columns == 1 else width + room
        dy = asked["dy"] if asked["dy"] or rows == 1 else height + room
        return replace(job, copies=Copies(columns, rows, dx, dy))

    def _show_copies(self, job: Job) -> None:
        copies = job.copies
        self.columns.show_value(copies.columns)
        self.rows_of.show_value(copies.rows)
        self.dx.show_value(copies.dx)
        self.dy.show_value(copies.dy)
        self.dx.setVisible(copies.columns > 1)
        self.dy.setVisible(copies.rows > 1)
        self.copies_picture.show_values(copies.columns, copies.rows)
        self.copies_group.say(f"{copies.columns} \u00d7 {copies.rows}" if copies.columns * copies.rows > 1 else "none")

    def _show_clamps(self, job: Job) -> None:
        names = [layer.name for layer in job.part.layers]
        several = ", ".join(job.keep_out_layers)
        choices: list[tuple[object, str]] = [("", "None"), *((name, name) for name in names)]
        chosen: object = job.keep_out_layers[0] if job.keep_out_layers else ""
        if len(job.keep_out_layers) > 1 or chosen not in ("", *names):
            choices.append((job.keep_out_layers, several))
            chosen = job.keep_out_layers
        self.clamps.set_choices(choices)
        self.clamps.show_value(chosen)
        self.clamp_height.show_value(job.keep_out_height)
        self.clamp_height.setVisible(bool(job.keep_out_layers))
        self.clamps_group.say(several or "none")

    def _show_notes(self, job: Job) -> None:
        self.clamping.show_value(job.clamping_note)
        self.zero.show_value(job.zero_note)
        self.notes_group.say("; ".join(filter(None, (job.clamping_note, job.zero_note))) or "no note")

    def show_job(self, job: Job) -> None:
        """Show the job's values."""
        self.margin.show_value(job.stock.margin)
        self.thickness.show_value(job.stock.thickness)
        self.above.show_value(job.stock.above)
        self.origin_xy.show_value(job.origin_xy)
        self.origin_z.show_value(job.origin_z)
        self.safe_z.show_value(job.safe_z)
        self.join.show_value(job.join_tolerance)
        self.order.show_value(job.order)
        unknown = {} if job.post in self._posts else {job.post: f"{job.post} (unknown)"}
        self.post.set_choices(list((self._posts | unknown).items()))
        self.post.show_value(job.post)
        self.units.show_value(job.out_units)
        self._show_copies(job)
        self._show_clamps(job)
        self._show_notes(job)

    def show_size(self, size: tuple[float, float] | None) -> None:
        """Take the size of one part in the plane, mm."""
        self._size = size
