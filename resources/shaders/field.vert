#version 330
// The top of the metal: a strip of triangles for every row, made from the number of the vertex alone.
uniform sampler2D heights;
uniform mat4 to_clip;
uniform vec3 corner;      // x0, y0, pitch: mm
uniform ivec2 first;      // the first column and row that are drawn
uniform ivec2 last;       // the last ones
uniform ivec2 last_cell;  // the last ones that there are
uniform int stride;       // cells from vertex to vertex
uniform float floor_z;
uniform vec3 section;     // normal and offset of the plane that takes metal away
out vec2 cell;
out float level;          // height in cells

void main() {
    ivec2 at = min(first + ivec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) * stride, last);
    cell = vec2(at) + 0.5;
    if (at.x == 0) cell.x = 0.0;
    if (at.y == 0) cell.y = 0.0;
    if (at.x == last_cell.x) cell.x = float(last_cell.x + 1);
    if (at.y == last_cell.y) cell.y = float(last_cell.y + 1);
    vec3 place = vec3(corner.xy + cell * corner.z, texelFetch(heights, at, 0).r);
#ifdef TOP_CLIPPED
    gl_ClipDistance[0] = section.z - dot(section.xy, place.xy);
    gl_ClipDistance[1] = place.z - floor_z - 1e-4;
#endif
    level = place.z / corner.z;
    gl_Position = to_clip * vec4(place, 1.0);
}
