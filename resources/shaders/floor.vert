#version 330
// The underside of the stock: one square.
uniform sampler2D heights;
uniform mat4 to_clip;
uniform vec3 corner;
uniform float floor_z;
uniform vec3 section;
out vec3 place;
flat out vec3 side;

void main() {
    vec2 inside = vec2(gl_VertexID & 1, gl_VertexID >> 1) * vec2(textureSize(heights, 0));
    place = vec3(corner.xy + inside * corner.z, floor_z);
    side = vec3(0.0, 0.0, -1.0);
    gl_ClipDistance[0] = section.z - dot(section.xy, place.xy);
    gl_Position = to_clip * vec4(place, 1.0);
}
