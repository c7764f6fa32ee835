#version 330
// Facets as coloured glass, each with one normal and dark edges.
uniform vec3 inks[2];     // of cylinders and of wedges
uniform vec3 light;       // towards the light, length 1
uniform vec3 strength;    // of the ambient light, of the light, of its mirror image
uniform float share;      // of the alpha
in vec3 place;
in vec2 inside;
flat in uint body;
out vec4 colour;

void main() {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)) + vec3(0.0, 0.0, 1e-12));
    if (normal.z < 0.0) normal = -normal;
    vec2 px = fwidth(inside), border = min(inside, 1.0 - inside) / max(px, vec2(1e-6));
    float line = 1.0 - smoothstep(0.35, 1.15, min(border.x, border.y));
    line *= 1.0 - smoothstep(0.12, 0.34, max(px.x, px.y));
    vec3 lit = inks[body] * (strength.x + strength.y * max(dot(normal, light), 0.0));
    colour = vec4(mix(lit, inks[body] * 0.28, line), share * mix(0.62, 0.92, line));
}
