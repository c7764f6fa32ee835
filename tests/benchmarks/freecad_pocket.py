"""Runs inside FreeCAD (`freecadcmd`): an Offset pocket of what PART describes; its G-code goes to OUT, the time to
OUT.json.

PART is JSON: regions as lists of contours, each a list of ["line", a, b], ["arc", a, middle, b] or ["circle", centre,
radius]; box, depth, diameter, stepover_percent.
"""

import json
import os
import time

import FreeCAD
import Part
import PathScripts.PathJob as PathJob
import PathScripts.PathPocketShape as PathPocketShape

MARGIN, THICKNESS = 5.0, 10.0


def edge(kind, *points):
    at = [FreeCAD.Vector(*point, 0) for point in points if not isinstance(point, float)]
    if kind == "line":
        return Part.makeLine(*at)
    return Part.Arc(*at).toShape() if kind == "arc" else Part.makeCircle(points[1], at[0])


def solid_of(part):
    x0, y0, x1, y1 = part["box"]
    corner = FreeCAD.Vector(x0 - MARGIN, y0 - MARGIN, -THICKNESS)
    solid = Part.makeBox(x1 - x0 + 2 * MARGIN, y1 - y0 + 2 * MARGIN, THICKNESS, corner)
    for region in part["regions"]:
        wires = [Part.Wire(Part.__sortEdges__([edge(*each) for each in contour])) for contour in region]
        solid = solid.cut(Part.Face(wires).extrude(FreeCAD.Vector(0, 0, -part["depth"])))
    return solid


def pocket_of(part):
    document = FreeCAD.newDocument("bench")
    model = document.addObject("Part::Feature", "Model")
    model.Shape = solid_of(part)
    document.recompute()
    job = PathJob.Create("Job", [model], None)
    clone, tool = job.Model.Group[0], job.Tools.Group[0]
    tool.Tool.Diameter = part["diameter"]
    tool.HorizFeed, tool.VertFeed = 10.0, 200 / 60
    floors = [box.ZMin + part["depth"] for box in (face.BoundBox for face in clone.Shape.Faces)]
    flat = [box.ZLength for box in (face.BoundBox for face in clone.Shape.Faces)]
    names = tuple(
        f"Face{k}" for k, (low, high) in enumerate(zip(floors, flat, strict=True), 1) if abs(low) < 1e-6 and high < 1e-6
    )
    pocket = PathPocketShape.Create("Pocket")
    pocket.Base, pocket.ToolController = [(clone, names)], tool
    pocket.OffsetPattern, pocket.StepOver, pocket.ExtraOffset = "Offset", int(part["stepover_percent"]), 0.0
    for name, value in (("StartDepth", 0.0), ("FinalDepth", -part["depth"]), ("StepDown", part["depth"])):
        pocket.setExpression(name, None)
        setattr(pocket, name, value)
    return document, pocket


def main():
    with open(os.environ["PART"]) as file:
        document, pocket = pocket_of(json.load(file))
    begin = time.perf_counter()
    pocket.touch()
    document.recompute()
    seconds = time.perf_counter() - begin
    with open(os.environ["OUT"], "w") as file:
        file.write(pocket.Path.toGCode())
    with open(os.environ["OUT"] + ".json", "w") as file:
        json.dump({"seconds": seconds, "version": ".".join(FreeCAD.Version()[:3])}, file)


main()
