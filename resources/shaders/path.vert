#version 330
// The tool's way: a ribbon of some pixels' width for every straight piece.
uniform mat4 to_clip;
uniform vec2 size;        // of the picture, px
uniform vec4 colours[4];  // by look
uniform float widths[4];  // px
uniform vec3 offset;      // towards the eye, mm
uniform float scale;      // px per mm
uniform vec3 section;
in vec3 from;
in vec3 to;
in float gone;            // mm along the path before this piece
in uint look;
out vec4 tint;
out float along;          // px
out float across;         // px from the middle
out float half_width;
flat out uint kind;

void main() {
    vec4 a = to_clip * vec4(from + offset, 1.0), b = to_clip * vec4(to + offset, 1.0);
    vec2 way = (b.xy - a.xy) * size / 2.0;
    float length_px = length(way);
    vec2 ahead = length_px > 1e-6 ? way / length_px : vec2(1.0, 0.0);
    bool at_end = (gl_VertexID & 2) != 0;
    float aside = (gl_VertexID & 1) != 0 ? 1.0 : -1.0;
    half_width = widths[look] / 2.0;
    across = aside * (half_width + 0.75);
    vec2 shift = vec2(-ahead.y, ahead.x) * across + ahead * (at_end ? 0.4 : -0.4);
    vec4 place = at_end ? b : a;
    gl_Position = vec4(place.xy + shift * 2.0 / size, place.z, 1.0);
    gl_ClipDistance[0] = section.z - dot(section.xy, at_end ? to.xy : from.xy);
    along = (gone + (at_end ? distance(from, to) : 0.0)) * scale;
    tint = colours[look];
    kind = look;
}
