"""What the small pictures show: passes, entry, side, lead, tab, finish, dog-bone, peck, copies, holder. Sizes in px of
150 x 70.
"""

from __future__ import annotations

import math

from .sketch import Sketch

TOP, FLOOR = 14.0, 62.0


def passes(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw depth passes. Values: depth, stepdown, finish depth, floor to leave, mm."""
    depth, stepdown, finish, leave = values
    scale = (FLOOR - TOP) / depth
    floor = TOP + (depth - leave) * scale
    sketch.metal(
        [(2, TOP), (34, TOP), (34, floor), (112, floor), (112, TOP), (144, TOP), (144, FLOOR + 5), (2, FLOOR + 5)]
    )
    rough = depth - leave - finish
    count = min(max(1, math.ceil(rough / stepdown - 1e-9)), 24)
    for k in range(1, count + (finish > 0)):
        y = TOP + rough * k / count * scale
        sketch.guide([(34, y), (112, y)])
    if finish > 0:
        sketch.path([(34, floor - 0.8), (112, floor - 0.8)])
    if leave > 0:
        sketch.guide([(34, FLOOR), (112, FLOOR)])
    sketch.tool(58, TOP + rough / count * scale, 26, 2)
    sketch.measure((98, TOP), (98, floor))


def entry(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw the way down. Values: 0 helix, 1 ramp, 2 plunge, 3 pre-drilled; angle, degrees."""
    kind, angle = int(values[0]), values[1]
    hole = [(56, TOP), (56, FLOOR), (80, FLOOR), (80, TOP)] if kind == 3 else []
    sketch.metal(
        [
            (2, TOP + 6),
            *[(x, y + 6 if y == TOP else y) for x, y in hole],
            (144, TOP + 6),
            (144, FLOOR + 6),
            (2, FLOOR + 6),
        ]
    )
    slope = math.tan(math.radians(min(max(angle, 4.0), 40.0)))
    if kind == 0:
        rise = max(slope * 34, 5.0)
        y, points = TOP - 6, []
        for k in range(400):
            turn = k / 10
            height = y + rise * turn / math.tau
            if height > FLOOR:
                break
            points.append((68 + 18 * math.cos(turn), height + 3 * math.sin(turn)))
        sketch.path(points)
    elif kind == 1:
        wide = 84.0
        points = [(26.0, TOP)]
        while points[-1][1] < FLOOR - 0.1 and len(points) < 30:
            points.append((26 + wide if len(points) % 2 else 26.0, min(points[-1][1] + wide * slope, FLOOR)))
        sketch.path(points)
    else:
        sketch.path([(68, 4), (68, FLOOR)])
    if kind < 2:
        sketch.word(112, TOP, f"{angle:.1f}°")


def side(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw a part from above with the path inside, outside or on its outline. Values: 0, 1, 2."""
    kind = int(values[0])
    outline = [(34, 16), (94, 16), (112, 34), (112, 56), (34, 56)]
    inner = [(43, 25), (90, 25), (103, 38), (103, 47), (43, 47)]
    outer = [(25, 7), (97, 7), (121, 30), (121, 65), (25, 65)]
    if kind == 1:
        sketch.metal(outline)
    elif kind == 0:
        sketch.metal([(8, 2), (138, 2), (138, 69), (8, 69)])
        sketch.metal(outline)
    else:
        sketch.guide([*outline, outline[0]])
    way = (inner, outer, outline)[kind]
    sketch.path([*way, way[0]])
    sketch.disc(way[0][0], 40, 18)


def lead(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw how a path comes to its wall. Values: 0 arc, 1 line, 2 none; radius and overlap as shares of the
    diameter.
    """
    kind, radius, overlap = int(values[0]), min(max(values[1], 0.15), 1.2) * 24, min(values[2], 1.5) * 24
    wall, path = 62.0, 50.0
    sketch.metal([(2, wall), (146, wall), (146, 69), (2, 69)])
    x = 76.0
    if kind == 0:
        sketch.arc((x, path - radius), radius, 180, 90)
        sketch.arc((x + overlap, path - radius), radius, 270, 90)
    elif kind == 1:
        sketch.path([(x, path - radius), (x, path)])
        sketch.path([(x + overlap, path), (x + overlap, path - radius)])
    sketch.path([(6, path), (142, path)])
    sketch.disc(x, path, 24)
    if overlap > 2:
        sketch.measure((x, 69 - 3), (x + overlap, 69 - 3))


def tab(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw a tab in a slot. Values: width and height, mm; depth, mm; number a contour."""
    width, height, depth, count = values
    scale = (FLOOR - TOP) / max(depth, 1e-6)
    rise = min(height, depth) * scale
    wide = min(max(width * scale, 8.0), 70.0)
    left, right = 74 - wide / 2, 74 + wide / 2
    raised = [(left, FLOOR), (left, FLOOR - rise), (right, FLOOR - rise), (right, FLOOR)] if count else []
    sketch.metal([(2, FLOOR), *raised, (146, FLOOR), (146, 69), (2, 69)])
    over = (
        [(left - 7, FLOOR - 1), (left - 7, FLOOR - rise - 1), (right + 7, FLOOR - rise - 1), (right + 7, FLOOR - 1)]
        if count
        else []
    )
    sketch.path([(6, FLOOR - 1), *over, (142, FLOOR - 1)])
    sketch.tool(24, FLOOR - 1, 14)
    if count:
        sketch.measure((right + 16, FLOOR), (right + 16, FLOOR - rise))
        sketch.measure((left, FLOOR - rise - 8), (right, FLOOR - rise - 8))


def wall(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw what is left on a wall, and what the finish pass takes. Values: stock to leave, finish width, diameter,
    mm.
    """
    leave, finish, diameter = values
    scale = 30 / max(diameter, 1e-6)
    stands, takes = min(leave * scale, 30.0), min(finish * scale, 26.0)
    x = 112 - stands
    sketch.metal([(112, 8), (144, 8), (144, 64), (112, 64)])
    if leave:
        sketch.guide([(x, 8), (x, 64)])
        sketch.measure((x, 66), (112, 66))
    if finish:
        sketch.guide([(x - takes, 8), (x - takes, 64)])
        sketch.disc(x - takes - 15, 26, 30, before=True)
    sketch.disc(x - 15, 46, 30)
    sketch.path([(x - 15, 66), (x - 15, 6)])


def dog_bone(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw an inner corner with the cutter in it. Values: 1 with a dog-bone, 0 without."""
    sketch.metal([(2, 8), (104, 8), (104, 69), (144, 69), (144, 2), (2, 2)])
    if values[0]:
        sketch.path([(6, 24), (88, 24), (95, 17), (88, 24), (88, 66)])
        sketch.disc(92.7, 19.3, 32)
    else:
        sketch.path([(6, 24), (88, 24), (88, 66)])
        sketch.disc(88, 24, 32)


def peck(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw a hole and the drill's strokes. Values: depth, peck (0 = in one go), through, mm."""
    depth, step, through = values
    scale = (FLOOR - TOP) / (depth + through)
    bottom, floor = FLOOR, TOP + depth * scale
    sketch.metal([(2, TOP), (60, TOP), (60, floor), (88, floor), (88, TOP), (146, TOP), (146, floor), (2, floor)])
    count = min(max(1, math.ceil((depth + through) / step - 1e-9)), 12) if step else 1
    points: list[tuple[float, float]] = []
    for k in range(1, count + 1):
        x = 74 - 5 * (count - 1) / 2 + 5 * (k - 1) if count < 6 else 62 + 24 * (k - 1) / (count - 1)
        points += [(x, 4), (x, TOP + (bottom - TOP) * k / count), (x, 4)]
    sketch.path(points, thin=count > 1)
    sketch.measure((104, TOP), (104, bottom))


def copies(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw parts in a grid. Values: columns, rows."""
    columns, rows = min(int(values[0]), 6), min(int(values[1]), 4)
    wide, high = min(132 / columns, 40.0), min(60 / rows, 28.0)
    for row in range(rows):
        for column in range(columns):
            x, y = 6 + column * wide, 66 - (row + 1) * high
            points = [(x, y + high * 0.2), (x + wide * 0.8, y + high * 0.2), (x + wide * 0.8, y + high), (x, y + high)]
            if row == column == 0:
                sketch.metal(points)
                continue
            sketch.guide([*points, points[0]])


def assembly(sketch: Sketch, values: tuple[float, ...]) -> None:
    """Draw a tool lying in its holder. Values: diameter, flute length, shank, stick-out, and height and radius of the
    outline, mm.

    What is not known, 0, is drawn as is usual: such a shank dashed.
    """
    diameter, flutes, shank, out = values[:4]
    outline = list(zip(values[4::2], values[5::2], strict=True))
    flutes, shank = flutes or 3 * diameter, shank or diameter
    out = max(out or flutes + 2 * shank, 1e-3)
    tall = max(diameter, shank, *(2 * radius for _, radius in outline), 1e-3)
    shown = out + (min(outline[-1][0], 1.5 * tall) if outline else 0.0)
    scale, middle = min(140.0 / shown, 58.0 / tall), 38.0
    stop = min(flutes, out) * scale
    if outline:
        points = [(min(4 + (out + height) * scale, 148.0), radius * scale) for height, radius in outline]
        sketch.metal([*((x, middle - y) for x, y in points), *((x, middle + y) for x, y in reversed(points))])
        if values[3]:
            sketch.measure((4, 6), (4 + out * scale, 6))
            sketch.guide([(4 + out * scale, 6), (4 + out * scale, middle - points[0][1])])
    half, thick = diameter * scale / 2, shank * scale / 2
    line = sketch.outline if values[1] and values[2] else sketch.guide
    line(
        [
            (4 + stop, middle - thick),
            (4 + out * scale, middle - thick),
            (4 + out * scale, middle + thick),
            (4 + stop, middle + thick),
            (4 + stop, middle - thick),
        ]
    )
    sketch.path(
        [
            (4, middle - half),
            (4 + stop, middle - half),
            (4 + stop, middle + half),
            (4, middle + half),
            (4, middle - half),
        ],
        True,
    )
