#version 330
// Depths alone are wanted. Of a facet that is seen all but on edge the hardware may take them from far off its plane.
flat in vec2 depths;

void main() {
    gl_FragDepth = clamp(gl_FragCoord.z, depths.x, depths.y);
}
