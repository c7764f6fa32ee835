#version 330
// A curtain from the metal's top down to the floor: the sides of the stock, and the face of the section.
uniform sampler2D heights;
uniform mat4 to_clip;
uniform vec3 corner;      // x0, y0, pitch: mm
uniform float floor_z;
uniform vec2 begin;       // mm
uniform vec2 end;
uniform int pieces;
uniform vec3 facing;      // the outward normal
uniform vec3 section;
out vec3 place;
flat out vec3 side;

void main() {
    vec2 at = mix(begin, end, float(gl_VertexID >> 1) / float(pieces));
    vec2 inside = (at - corner.xy) / corner.z;
    float top = textureLod(heights, inside / vec2(textureSize(heights, 0)), 0.0).r;
    bool low = (gl_VertexID & 1) == 1;
    place = vec3(at, low ? floor_z : max(top, floor_z));
    side = facing;
    gl_ClipDistance[0] = section.z - dot(section.xy, at);
    gl_Position = to_clip * vec4(place, 1.0);
}
