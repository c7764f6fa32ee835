#version 330
// A quad over the cells that one piece of a path may lower, and what each of them must know of the piece.
uniform vec2 size;         // of the picture, cells
uniform float pitch;       // mm
uniform vec4 tool;         // radius, flat, fillet, slope of the cone (0 = none), mm
uniform float span;        // radius that the fillet takes, mm
const float MARGIN = 0.03; // cells; more than places are rounded on the way to the picture
const float LEAST = 0.5;   // cells; a quad is as long to each side of its middle, so that `cell` can be told well

out vec2 cell;             // from the anchor, once it is rounded: gl_FragCoord is slow in software, and noperspective wrong where it clips
in vec4 anchor;            // column and row of a cell; straight: its a and c; arc: the direction to it from the centre

#ifdef ARC
in vec4 circle;            // how far the anchor is beyond it, 1 / its radius, z of the tip, half the quad's width in cells
in vec4 ends;              // anchor from start and from end, mm
in vec4 box;               // from the anchor to the middle, from there to the middle of the far side, cells
flat out vec2 normal;      // direction to the anchor
flat out vec4 bend;        // as circle; the last one is pitch
flat out vec4 from_ends;
flat out vec4 tangents;    // at start and end, length 1
#else
in vec4 way;               // b; how a changes with columns and rows; rise
in vec4 reach;             // from where to where along the piece, from the anchor, mm; z of the tip at both ends
flat out vec4 along;       // a, b, c of the anchor; rise
flat out vec2 steps;       // of a
flat out vec4 more;        // z of both ends; ball: s² / (1 + s²), 1 + s²; cone: s / sqrt(m² - s²), 1 where it rises as the cone or more;
                           // taper: and s / sqrt(1 + s²) with a sign of minus where it rises so; bull: flat * sqrt(1 + s²), fillet * s
#ifdef BULL
flat out vec4 lines[3];    // lie below what `contact` solves
#endif
#endif

#ifdef BULL
vec2 tangent(float y, float wide, float deep) {
    float w = inversesqrt(1.0 + y * y);
    float rise = wide * w * w * w + deep;
    return vec2(1.0 / rise, y - (wide * w + deep) * y / rise);
}
#endif

void main() {
    float side = (gl_VertexID & 1) != 0 ? 1.0 : -1.0;
    bool far = (gl_VertexID & 2) != 0;
#ifdef ARC
    float wide = length(box.zw), reach = max(wide + MARGIN, LEAST);
    vec2 ahead = box.zw / wide, aside = vec2(-ahead.y, ahead.x);
    cell = box.xy + ahead * (far ? reach : -reach) + aside * side * max(circle.w + MARGIN, LEAST);
    normal = anchor.zw;
    bend = vec4(circle.xyz, pitch);
    from_ends = ends;
    vec2 out_to = anchor.zw * (1.0 + circle.x * circle.y);  // anchor from the centre, in radii
    vec2 start = out_to - ends.xy * circle.y, stop = out_to - ends.zw * circle.y;
    tangents = vec4(-start.y, start.x, -stop.y, stop.x);
#else
    vec2 ahead = way.yz / pitch, aside = vec2(-ahead.y, ahead.x);
    float middle = (reach.x + reach.y) / 2.0, wide = max(reach.y - middle + MARGIN * pitch, LEAST * pitch);
    float apart = max(tool.x + MARGIN * pitch, LEAST * pitch);
    cell = (ahead * (far ? middle + wide : middle - wide) + aside * (side * apart - anchor.w)) / pitch;
    along = vec4(anchor.z, way.x, anchor.w, way.w);
    steps = way.yz;
    float s = way.w;
    float stretch = 1.0 + s * s;
    more = vec4(reach.zw, 0.0, 0.0);
#if defined(BALL)
    more = vec4(reach.zw + tool.x, s * s / stretch, stretch);
#elif defined(CONE) || defined(TAPER)
    bool steep = s >= tool.w;
    more.z = steep ? 0.0 : s * inversesqrt((tool.w - s) * (tool.w + s));
#ifdef CONE
    more.w = steep ? 1.0 : 0.0;
#else
    more.w = s * inversesqrt(stretch) * (steep ? -1.0 : 1.0);
#endif
#elif defined(BULL)
    float broad = tool.y * sqrt(stretch), deep = tool.z * s;
    more.zw = vec2(broad, deep);
    lines[0] = vec4(tangent(0.0, broad, deep), 1.0 / deep, -broad / deep);
    lines[1] = vec4(tangent(1.5, broad, deep), tangent(4.0, broad, deep));
    lines[2] = vec4(tangent(12.0, broad, deep), tangent(50.0, broad, deep));
#endif
#endif
    gl_Position = vec4((anchor.xy + 0.5 + cell) / size * 2.0 - 1.0, 0.0, 1.0);
}
