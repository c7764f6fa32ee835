#version 330
// Facets of a sweep, by parallel projection along the tool's axis: the dexel grid is the frame buffer, its centres are the pixels'.
uniform vec3 scale;       // 2 / the grid's width, 2 / its height, 2 / what of the heights matters, 1 / mm
in vec3 a, b, c, d;       // corners, mm from the grid's lower left one, and from the lowest height that matters
flat out vec2 depths;     // the least and the greatest of the facet

void main() {
    vec3 strip[4] = vec3[4](b, c, a, d);
    gl_Position = vec4(strip[gl_VertexID] * scale - 1.0, 1.0);
    vec2 span = vec2(min(min(a.z, b.z), min(c.z, d.z)), max(max(a.z, b.z), max(c.z, d.z)));
    depths = clamp(span * scale.z * 0.5, 0.0, 1.0);
}
