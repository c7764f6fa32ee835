#version 330
// The top of the metal: a strip of triangles for every row, made from the number of the vertex alone.
uniform sampler2D heights;
uniform mat4 to_clip;
uniform vec3 corner;      // x0, y0, pitch: mm
uniform ivec2 first;      // the first column and row that are drawn
uniform ivec2 last;       // the last ones
uniform int stride;       // cells from vertex to vertex
uniform vec3 section;     // normal and offset of the plane that takes metal away; normal 0 = none
out vec3 place;
flat out vec3 side;

void main() {
    ivec2 count = textureSize(heights, 0);
    ivec2 cell = min(first + ivec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) * stride, last);
    vec2 inside = vec2(cell) + 0.5;
    inside = mix(inside, vec2(0.0), equal(cell, ivec2(0)));
    inside = mix(inside, vec2(count), equal(cell, count - 1));
    place = vec3(corner.xy + inside * corner.z, texelFetch(heights, cell, 0).r);
    side = vec3(0.0);
    gl_ClipDistance[0] = section.z - dot(section.xy, place.xy);
    gl_Position = to_clip * vec4(place, 1.0);
}
