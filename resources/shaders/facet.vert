#version 330
// A facet of a sweep: four corners, one after the other round it.
uniform mat4 to_clip;
uniform vec3 offset;      // towards the eye, mm
in vec3 a;
in vec3 b;
in vec3 c;
in vec3 d;
in uint kind;             // 0 = of a cylinder, 1 = of a wedge
out vec3 place;
out vec2 inside;          // 0 to 1 from side to side
flat out uint body;

void main() {
    inside = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = inside.y < 0.5 ? (inside.x < 0.5 ? a : b) : (inside.x < 0.5 ? d : c);
    body = kind;
    gl_Position = to_clip * vec4(place + offset, 1.0);
}
