#version 330
// Rectangles of the picture, one for each instance.
in vec4 part;                 // x0, y0, x1, y1, shares of the picture from the lower left
void main() {
    vec2 at = mix(part.xy, part.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
