# mypy: allow-untyped-defs
"""Compiled: surfaces and lines as pixels, with a depth for each pixel, so that what crosses does so at the right place.

A frame is what a camera sees: its axes (to the right, up, towards the eye), its target, px per mm, width and height in
px. Depths are mm towards the eye; -inf where nothing is.
"""

from __future__ import annotations

import math

from ....core.jit import kernel

_R, _POINTS, _TRIANGLES = "float64[::1]", "float64[:, ::1]", "float64[:, :, ::1]"
_DEPTHS, _OWNERS, _LIGHTS, _PIXELS = "float32[:, ::1]", "int16[:, ::1]", "float32[:, ::1]", "uint8[:, :, ::1]"
TARGET, SCALE, WIDE, HIGH = 9, 12, 13, 14
"""Of a frame (15,): behind nine numbers of the axes."""
WIDTH, PATTERN, HIDDEN, BIAS, STRENGTH, LEAST = 3, 4, 8, 9, 10, 11
"""Of a pen (12,): behind its blue, green and red: px wide; dash and gap twice, px; how much is left of it where it is
hidden, how far behind a surface it is before that, mm, how strong it is where it is not, up to 1; and px: shorter steps
are joined with the next.
"""
_DARKEST = 0.62


@kernel(f"UniTuple(float64, 3)(float64, float64, float64, {_R})")
def seen(x, y, z, frame):
    """Return px from the left, px from the top, mm towards the eye."""
    x, y, z = x - frame[TARGET], y - frame[TARGET + 1], z - frame[TARGET + 2]
    across = frame[0] * x + frame[1] * y + frame[2] * z
    up = frame[3] * x + frame[4] * y + frame[5] * z
    near = frame[6] * x + frame[7] * y + frame[8] * z
    return frame[WIDE] / 2 + across * frame[SCALE], frame[HIGH] / 2 - up * frame[SCALE], near


@kernel(f"float64({_TRIANGLES}, int64, {_R})")
def _shade(triangles, n, frame):
    """Return how light a triangle is, from a light over the viewer's shoulder; both sides alike."""
    t = triangles[n]
    ux, uy, uz = t[1, 0] - t[0, 0], t[1, 1] - t[0, 1], t[1, 2] - t[0, 2]
    vx, vy, vz = t[2, 0] - t[0, 0], t[2, 1] - t[0, 1], t[2, 2] - t[0, 2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    size = math.sqrt(x * x + y * y + z * z)
    if size == 0.0:
        return 1.0
    lit = 0.0
    for axis in range(3):
        # The light's direction, in the camera's axes: from the left, from above, from the viewer's side.
        lean = (-0.45, 0.55, 0.70)[axis]
        lit += lean * (frame[3 * axis] * x + frame[3 * axis + 1] * y + frame[3 * axis + 2] * z) / size
    return _DARKEST + (1.0 - _DARKEST) * min(abs(lit), 1.0)


@kernel(f"void({_TRIANGLES}, int64[::1], boolean[::1], {_R}, {_DEPTHS}, {_OWNERS}, {_LIGHTS})")
def fill(triangles, owner, shown, frame, depths, owners, lights):
    """Draw triangles (n, 3, 3), each pixel that of the nearest.

    Args:
        owner: (n,) whose they are; shown: of each owner, whether it is drawn.
        depths, owners, lights: out; -1 where nothing is.
    """
    high, wide = depths.shape
    for n in range(len(triangles)):
        if not shown[owner[n]]:
            continue
        ax, ay, az = seen(triangles[n, 0, 0], triangles[n, 0, 1], triangles[n, 0, 2], frame)
        bx, by, bz = seen(triangles[n, 1, 0], triangles[n, 1, 1], triangles[n, 1, 2], frame)
        cx, cy, cz = seen(triangles[n, 2, 0], triangles[n, 2, 1], triangles[n, 2, 2], frame)
        twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if twice == 0.0:
            continue
        top, bottom = max(math.ceil(min(ay, by, cy) - 0.5), 0), min(math.floor(max(ay, by, cy) - 0.5), high - 1)
        left, right = max(math.ceil(min(ax, bx, cx) - 0.5), 0), min(math.floor(max(ax, bx, cx) - 0.5), wide - 1)
        if top > bottom or left > right:
            continue
        light = _shade(triangles, n, frame)
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                # Barycentric shares of the pixel's middle; an edge's pixels are both neighbours', so that no gap
                # shows between.
                a = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / twice
                b = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / twice
                if a < -1e-9 or b < -1e-9 or a + b > 1.0 + 1e-9:
                    continue
                near = a * az + b * bz + (1.0 - a - b) * cz
                if near > depths[row, column]:
                    depths[row, column], owners[row, column], lights[row, column] = near, owner[n], light


@kernel(f"void({_DEPTHS}, {_OWNERS}, {_LIGHTS}, {_POINTS}, float64, {_DEPTHS}, {_OWNERS}, {_PIXELS})")
def tint(fine_depths, fine_owners, lights, inks, strength, depths, owners, image):
    """Lay the colours of owners over a picture, each pixel the mean of its samples, so that outlines have no stairs.

    The light darkens what the colour and the picture mix to: so a shaded place keeps its hue.

    Args:
        fine_depths, fine_owners, lights: of the samples, a whole number of them for each pixel, both ways.
        inks: (k, 3) blue, green, red of each owner. strength: of them over the picture, in [0, 1].
        depths, owners: out; of the nearest surface, its mean there: the nearest sample would hide lines on a slope.
        image: painted over.
    """
    high, wide = depths.shape
    times = fine_depths.shape[0] // high
    share = 1.0 / (times * times)
    for row in range(high):
        for column in range(wide):
            whose, near = -1, depths[row, column]
            ground, blue, green, red = 0.0, 0.0, 0.0, 0.0
            for y in range(row * times, (row + 1) * times):
                for x in range(column * times, (column + 1) * times):
                    owner = fine_owners[y, x]
                    if owner < 0:
                        ground += 1.0
                        continue
                    if fine_depths[y, x] > near:
                        whose, near = owner, fine_depths[y, x]
                    light = lights[y, x]
                    ground += light * (1.0 - strength)
                    blue += light * inks[owner, 0]
                    green += light * inks[owner, 1]
                    red += light * inks[owner, 2]
            if whose < 0:
                continue
            depth, count = 0.0, 0
            for y in range(row * times, (row + 1) * times):
                for x in range(column * times, (column + 1) * times):
                    if fine_owners[y, x] == whose:
                        depth, count = depth + fine_depths[y, x], count + 1
            depths[row, column], owners[row, column] = depth / count, whose
            for c in range(3):
                ink = (blue, green, red)[c] * strength
                image[row, column, c] = int((ground * image[row, column, c] + ink) * share + 0.5)


@kernel(f"void(float64, float64, float64, float64, float64, float64, float64, {_R}, {_DEPTHS}, {_PIXELS})")
def _stroke(ax, ay, az, bx, by, bz, along, pen, depths, image):
    """Draw one straight piece with soft edges; `along`: px from the line's beginning to the piece's."""
    high, wide = depths.shape
    half = 0.5 * pen[WIDTH]
    reach = half + 1.0
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    size, period = math.sqrt(square), pen[PATTERN] + pen[PATTERN + 1] + pen[PATTERN + 2] + pen[PATTERN + 3]
    top, bottom = max(math.floor(min(ay, by) - reach), 0), min(math.ceil(max(ay, by) + reach), high - 1)
    for row in range(top, bottom + 1):
        y, left, right = row + 0.5, min(ax, bx) - reach, max(ax, bx) + reach
        if abs(dy) > 1e-9 and abs(dx) > abs(dy) * 4.0:  # of a flat piece only what is near this row
            at_0, at_1 = ax + dx * (y - reach - ay) / dy, ax + dx * (y + reach - ay) / dy
            left, right = max(left, min(at_0, at_1) - reach), min(right, max(at_0, at_1) + reach)
        for column in range(max(math.floor(left), 0), min(math.ceil(right), wide - 1) + 1):
            x = column + 0.5
            share = min(max(((x - ax) * dx + (y - ay) * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
            off = math.sqrt((x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2)
            # The edge falls from full to nothing over one pixel, half of it on either side.
            cover = min(half + 0.5 - off, 1.0)
            if cover <= 0.0:
                continue
            if period > 0.0:
                phase = (along + share * size) % period
                if pen[PATTERN] <= phase < pen[PATTERN] + pen[PATTERN + 1] or phase >= period - pen[PATTERN + 3]:
                    continue
            if az + share * (bz - az) < depths[row, column] - pen[BIAS]:
                cover *= pen[HIDDEN]
            cover *= pen[STRENGTH]
            for c in range(3):
                image[row, column, c] = int(image[row, column, c] * (1.0 - cover) + pen[c] * cover + 0.5)


@kernel(f"int64({_POINTS}, boolean[::1], {_R}, {_R}, {_DEPTHS}, {_PIXELS})")
def draw_lines(points, joined, frame, pen, depths, image):
    """Draw lines over a picture; return how many straight pieces that took.

    Args:
        points: (n, 3) mm. joined: (n,) whether a line goes on from each to the next.
        depths: of the surfaces, behind which lines are fainter.
    """
    high, wide = depths.shape
    edge, count, along = pen[WIDTH] + 2.0, 0, 0.0
    ax, ay, az, running = 0.0, 0.0, 0.0, False
    for n in range(len(points)):
        bx, by, bz = seen(points[n, 0], points[n, 1], points[n, 2], frame)
        if running:
            step = math.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
            # Pieces of less than a pixel would each blend over the last one's end and darken the line.
            if step < pen[LEAST] and joined[n]:
                continue
            inside = (
                min(ax, bx) < wide + edge and max(ax, bx) > -edge and min(ay, by) < high + edge and max(ay, by) > -edge
            )
            if inside:
                _stroke(ax, ay, az, bx, by, bz, along, pen, depths, image)
                count += 1
            along += step
        else:
            along = 0.0
        ax, ay, az, running = bx, by, bz, joined[n]
    return count
