#version 330
// Pocket paths are solid, contours dashed, rapids dotted.
uniform vec2 dashes[4];   // period and drawn part, px, by look
in vec4 tint;
in float along;
in float across;
in float half_width;
flat in uint kind;
out vec4 colour;

void main() {
    vec2 dash = dashes[kind];
    float alpha = clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
    if (dash.x > 0.0) {
        float at = mod(along, dash.x);
        alpha *= clamp(dash.y + 0.5 - at, 0.0, 1.0) + clamp(at - dash.x + 0.5, 0.0, 1.0);
    }
    if (alpha < 0.02) discard;
    colour = vec4(tint.rgb, tint.a * alpha);
}
