#version 330
// Metal, by following each pixel's line of sight over the heights: what it meets first is what is seen. Places are in
// cells: x and y are 1 at the centre of the first cell, heights are measured in cells too.
uniform sampler2D heights;    // mm
uniform sampler2D blocks;     // mm: the highest of the 8 x 8 squares between cells
uniform sampler2D relief;     // per cell: x and y of the normal as sign and root, the light that reaches a corner
uniform sampler2D walls;      // per cell: distance from the wall beside it, x and y of the direction that it faces
uniform sampler2D values;     // per cell: place in the palette
uniform sampler2D palette;    // 256 colours
uniform vec3 corner;          // x0, y0, pitch: mm
uniform ivec2 last_cell;
uniform float floor_z;        // mm
uniform float highest;        // mm
uniform vec3 eye;             // of the pixel at the lower left
uniform vec3 right;           // a pixel further
uniform vec3 up;
uniform vec3 away;            // from the eye, length 1
uniform float depth_gain;     // of a length along a line of sight
uniform float scale;          // pixels in a cell, or lines of sight where there are fewer of these
uniform float line_share;     // of an edge's colour in its line
uniform vec4 hole;            // x0, y0, x1, y1 of what somebody else paints
uniform vec4 stock_box;       // x0, y0, x1, y1 of the stock's sides
uniform vec3 section;         // normal and offset of the plane that takes metal away
uniform vec3 light;           // towards the light, length 1
uniform vec3 halfway;         // between the light and the eye, length 1
uniform vec3 stock;           // colours, 0 to 1
uniform vec3 hatch;
uniform vec3 edge;            // of fine lines where metal ends
uniform vec3 strength;        // of the ambient light, of the light, of its mirror image
uniform sampler2D uneven;     // of the picture with a line of sight in a pixel: where there may be more between
uniform int finer;            // 1 = this is the picture with two by two, where that is so
out vec4 colour;

const int BLOCK = 8;
const int MOST_STEPS = 20000;
const float NOTHING = -1e7;

vec4 height, side;            // of the corners of the square at hand; side > 0 at the foot of a wall, < 0 on top of it
vec2 faces[4];                // which way the wall faces that a corner lies beside
bool known, wall;             // whether all corners lie beside a wall; whether it stands in this square

void look_at(ivec2 square) {
    bool all_known = true;
    for (int k = 0; k < 4; ++k) {
        ivec2 cell = clamp(square - 1 + ivec2(k & 1, k >> 1), ivec2(0), last_cell);
        float z = texelFetch(heights, cell, 0).r;
        height[k] = z <= floor_z + 1e-4 ? NOTHING : z / corner.z;
        vec3 told = texelFetch(walls, cell, 0).rgb * 255.0;
        all_known = all_known && told.x > 0.5;
        side[k] = (told.x - 128.0) / 60.0;
        faces[k] = told.yz - 128.0;
    }
    known = all_known;
    wall = known && min(min(side.x, side.y), min(side.z, side.w)) < 0.0
        && max(max(side.x, side.y), max(side.z, side.w)) > 0.0;
}

vec4 weights(vec2 at, ivec2 square) {
    vec2 share = clamp(at - vec2(square), 0.0, 1.0);
    vec2 rest = 1.0 - share;
    return vec4(rest.x * rest.y, share.x * rest.y, rest.x * share.y, share.x * share.y);
}

// The height of the metal on one side of a wall.
float level(vec4 weight, bool foot) {
    vec4 own = foot ? vec4(greaterThan(side, vec4(0.0))) : vec4(lessThan(side, vec4(0.0)));
    vec4 mixed = weight * own + 1e-4 * own;
    return dot(mixed, height) / dot(mixed, vec4(1.0));
}

float surface(vec2 at, ivec2 square) {
    vec4 weight = weights(at, square);
    return wall ? level(weight, dot(weight, side) > 0.0) : dot(weight, height);
}

bool striped(float step, float width) {
    return mod(gl_FragCoord.x + gl_FragCoord.y, step) < width;
}

vec3 lit(vec3 base, vec3 normal, float open) {
    float mirrored = max(dot(normal, halfway), 0.0);
    mirrored *= mirrored;
    mirrored *= mirrored;
    mirrored *= mirrored;
    mirrored *= mirrored;
    return open * (base * (strength.x + strength.y * max(dot(normal, light), 0.0)) + strength.z * mirrored * mirrored);
}

vec2 aside_of(vec2 map) {
    vec2 root = map * (255.0 / 127.0) - (128.0 / 127.0);
    return root * abs(root);
}

float line_at(float cells) {
    return line_share * (1.0 - smoothstep(0.5, 1.3, cells * max(scale, 1.3)));  // nobody knows more than a cell's breadth
}

// Which way a wall faces: what the cells a little way along it say alike, for one alone knows the steps of the grid.
// Only at a wall: a loop that is not gone through costs nothing, what an `if` leaves out does.
vec2 facing_around(ivec2 here, vec2 facing, bool at_wall) {
    vec2 sum = facing;
    int count = at_wall ? 16 : 0;
    for (int k = 0; k < count; ++k) {
        ivec2 off = ivec2(k % 4, k / 4) * 2 - 3;
        vec3 told = texelFetch(walls, clamp(here + off, ivec2(0), last_cell), 0).rgb * 255.0;
        vec2 other = told.yz - 128.0;
        if (told.x > 0.5 && dot(other, facing) > 0.0) sum += other;
    }
    return normalize(sum + 1e-9);
}

// What is seen of metal that was met at its top, or at a wall: that belongs to whoever cut its foot.
vec3 metal(vec3 place, ivec2 square, bool at_wall) {
    vec4 weight = weights(place.xy, square);
    float from_side = dot(weight, side), open = 1.0, line = 0.0;
    bool foot = at_wall || from_side > 0.0;
    ivec2 near = clamp(ivec2(floor(place.xy - 0.5)), ivec2(0), last_cell);
    float most = -1.0;
    vec2 facing = vec2(0.0);
    for (int k = 0; k < 4; ++k) {
        facing += weight[k] * faces[k];
        if (wall && side[k] > 0.0 == foot && weight[k] > most) {
            most = weight[k];
            near = clamp(square - 1 + ivec2(k & 1, k >> 1), ivec2(0), last_cell);
        }
    }
    vec3 normal;
    vec2 faced = facing_around(near, facing, at_wall);
    if (at_wall) {
        normal = vec3(faced, 0.0);
        float low = max(level(weight, true), floor_z / corner.z), high = level(weight, false);
        open = 0.74 + 0.24 * sqrt(clamp((place.z - low) / max(high - low, 1e-3), 0.0, 1.0));
    } else {
        vec2 inside = (place.xy - 0.5) / vec2(last_cell + 1);
        vec3 map = wall ? texelFetch(relief, near, 0).rgb : textureLod(relief, inside, max(0.0, -log2(scale))).rgb;
        vec2 aside = aside_of(map.xy), border = min(place.xy - stock_box.xy, stock_box.zw - place.xy);
        normal = vec3(aside, sqrt(max(1.0 - dot(aside, aside), 0.0)));
        open = map.z;
        line = line_at(min(min(border.x, border.y), known && !foot ? -from_side : 1e9));
    }
    int number = int(texelFetch(values, near, 0).r * 255.0 + 0.5);
    vec3 base = texelFetch(palette, ivec2(number, 0), 0).rgb;
    if (number == 254 && striped(8.0, 2.5)) base = hatch;
    return mix(lit(base, normal, open), edge, line);
}

const int MISSED = 0, TOP = 1, WALL = 2, SIDE = 3, CUT = 4, UNDERSIDE = 5;

// What tells faces apart where they are equally bright: their kind, of tops their height over the floor, cells.
float face_of(int kind, int face, float height) {
    if (kind != TOP) return 0.08 * float(kind == SIDE ? face : kind);
    return 0.5 + 0.5 * clamp(height / max(highest / corner.z - floor_z / corner.z, 1e-3), 0.0, 1.0);
}

void main() {
    bool asked = finer == 0 || texelFetch(uneven, ivec2(gl_FragCoord.xy) / 2, 0).r > 0.0;
    vec3 start = eye + gl_FragCoord.x * right + gl_FragCoord.y * up, way = away;
    for (int k = 0; k < 3; ++k) if (abs(way[k]) < 1e-6) way[k] = way[k] < 0.0 ? -1e-6 : 1e-6;
    float lowest = floor_z / corner.z;
    vec3 low = vec3(0.5, 0.5, lowest), high = vec3(vec2(last_cell) + 1.5, highest / corner.z + 0.01);
    vec3 one = (low - start) / way, other = (high - start) / way;
    vec3 into = min(one, other), out_of = max(one, other);
    float begin = max(max(into.x, into.y), into.z), end = min(min(out_of.x, out_of.y), out_of.z);
    int face = into.x >= begin ? 0 : into.y >= begin ? 1 : 2;
    if (section.xy != vec2(0.0)) {
        float turn = dot(section.xy, way.xy), left = section.z - dot(section.xy, start.xy);
        if (abs(turn) < 1e-7) {
            if (left < 0.0) asked = false;
        } else if (turn > 0.0) {
            end = min(end, left / turn);
        } else if (left / turn > begin) {
            begin = left / turn;
            face = 3;
        }
    }
    int kind = MISSED, sights = asked && begin < end ? 1 : 0;
    colour = vec4(0.0);
    gl_FragDepth = 1.0;
    // A loop, as its body is all that a software renderer passes over where no pixel at hand has anything to do.
    for (int sight = 0; sight < sights; ++sight) {
        vec2 hole_one = (hole.xy - start.xy) / way.xy, hole_other = (hole.zw - start.xy) / way.xy;
        vec2 hole_in = min(hole_one, hole_other), hole_out = max(hole_one, hole_other);
        float gone = max(hole_in.x, hole_in.y), back = min(hole_out.x, hole_out.y);
        if (hole.z <= hole.x || gone >= back) gone = back = 3e38;

        // what is met where the line of sight comes to the stock
        vec3 place = start + begin * way, side_normal = vec3(0.0, 0.0, -1.0);
        ivec2 square = clamp(ivec2(floor(place.xy)), ivec2(0), last_cell + 1);
        float at = begin, below = -1.0;
        look_at(square);
        if (begin < gone || begin >= back) {
            float top = surface(place.xy, square);
            if (face == 2 && way.z > 0.0 && top > lowest) kind = UNDERSIDE;
            if (face != 2 && place.z < top) {
                side_normal = face == 3 ? vec3(section.xy, 0.0)
                    : face == 0 ? vec3(-sign(way.x), 0.0, 0.0) : vec3(0.0, -sign(way.y), 0.0);
                vec4 off = abs(vec4(place.xy, place.xy) - stock_box);
                bool outside = (face == 0 ? min(off.x, off.z) : min(off.y, off.w)) < 0.05;
                kind = face == 3 ? CUT : outside ? SIDE : TOP;
                if (kind == SIDE) below = top - place.z;
            }
        }

        vec2 forward = step(vec2(0.0), way.xy), per_cell = 1.0 / way.xy;
        for (int n = 0; n < MOST_STEPS && kind == MISSED && at < end; ++n) {
            if (at >= gone - 1e-4 && at < back) { at = back; continue; }
            float stop = at < gone ? min(end, gone) : end;
            vec2 here = start.xy + (at + 2e-4) * way.xy;
            square = clamp(ivec2(floor(here)), ivec2(0), last_cell + 1);
            ivec2 block = square / BLOCK;
            float most = texelFetch(blocks, block, 0).r / corner.z;
            vec2 exits = ((vec2(block) + forward) * float(BLOCK) - start.xy) * per_cell;
            float leave = max(min(min(exits.x, exits.y), stop), at + 4e-4);
            if (start.z + min(at * way.z, leave * way.z) > most) { at = leave; continue; }
            if (way.z < 0.0) {  // nothing here is met above the highest
                float reached = (most + 1e-3 - start.z) / way.z;
                if (reached > at + 1e-3) { at = reached; continue; }
            }
            exits = (vec2(square) + forward - start.xy) * per_cell;
            leave = max(min(min(exits.x, exits.y), stop), at + 4e-4);
            look_at(square);
            vec4 first = weights(start.xy + at * way.xy, square), last = weights(start.xy + leave * way.xy, square);
            float z_from = start.z + at * way.z, z_to = start.z + leave * way.z;
            float side_from = dot(first, side), side_to = dot(last, side);
            bool foot = side_from > 0.0, crosses = wall && foot != (side_to > 0.0);
            float share = crosses ? side_from / (side_from - side_to) : 1.0;
            vec4 between = mix(first, last, share);
            float before = (wall ? level(first, foot) : dot(first, height)) - z_from;
            float after = (wall ? level(between, foot) : dot(between, height)) - mix(z_from, z_to, share);
            if (before >= 0.0 || after >= 0.0) {
                kind = TOP;
                at = before >= 0.0 ? at : mix(at, leave, share * before / (before - after));
                break;
            }
            if (crosses) {
                before = level(between, !foot) - mix(z_from, z_to, share);
                after = level(last, !foot) - z_to;
                if (before >= 0.0 || after >= 0.0) {
                    kind = before >= 0.0 ? WALL : TOP;
                    float on = before >= 0.0 ? 0.0 : before / (before - after);
                    at = mix(mix(at, leave, share), leave, on);
                    break;
                }
            }
            at = leave;
        }
        vec3 base = kind == CUT && striped(10.0, 1.5) ? mix(stock, hatch, 0.55) : stock;
        vec3 seen = mix(lit(base, side_normal, 1.0), edge, below < 0.0 ? 0.0 : line_at(below));
        if (kind == TOP || kind == WALL) seen = metal(start + at * way, square, kind == WALL);
        colour = vec4(seen, face_of(kind, face, start.z + at * way.z - lowest));
        gl_FragDepth = 0.5 + depth_gain * at;
    }
    if (kind == MISSED) discard;
}
