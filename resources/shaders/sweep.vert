#version 330
// Facets of a sweep, by parallel projection along the tool's axis: the dexel grid is the frame buffer, its centres are the pixels'.
uniform vec3 scale;     // 2 / the grid's width, 2 / its height, 2 / what of the heights matters, 1 / mm
in vec3 place;          // mm from the grid's lower left corner, and from the lowest height that matters

void main() {
    gl_Position = vec4(place * scale - 1.0, 1.0);
}
