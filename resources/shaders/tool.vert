#version 330
// A tool: each piece of its outline becomes a ring round the axis, made from the number of the vertex.
uniform mat4 to_clip;
uniform vec3 tip;         // mm
uniform int sides;        // of a ring
in vec4 low;              // height over the tip, radius, mm; how far the normal points up, and out
in vec4 high;
in uint part;             // 0 = cutting, 1 = shank, 2 = holder
out vec3 normal;
out vec2 at;              // turns round the axis, height
flat out uint kind;

void main() {
    float turn = float(gl_VertexID >> 1) / float(sides);
    vec2 out_ = vec2(cos(6.28318530718 * turn), sin(6.28318530718 * turn));
    vec4 end = (gl_VertexID & 1) == 0 ? high : low;
    normal = vec3(out_ * end.w, end.z);
    at = vec2(turn, end.x);
    kind = part;
    gl_Position = to_clip * vec4(tip + vec3(out_ * end.y, end.x), 1.0);
}
