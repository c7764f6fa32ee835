#version 330
// A tool as glass with a rim: what faces the eye lets the metal through, what turns away from it draws the tool's shape.
uniform vec3 inks[3];     // of the cutting part, the shank, the holder
uniform vec2 alphas[3];   // of what faces the eye, and of what turns away
uniform vec3 light;       // towards the light, length 1
uniform vec3 halfway;     // between the light and the eye, length 1
uniform vec3 eye;         // towards the eye, length 1
uniform vec3 right;       // across the picture, length 1
uniform vec3 edge;        // colour of what turns away
uniform vec3 strength;    // of the ambient light, of the light, of its mirror image
uniform float flutes;     // cutting edges
uniform float lead;       // turns of an edge per mm
uniform float share;      // of the alphas
in vec3 normal;
in vec2 at;
flat in uint kind;
out vec4 colour;

// From an edge on, a flute is dark and becomes as bright as the land before the next edge.
float fluted() {
    float phase = flutes * (at.x - at.y * lead);
    float soft = min(1.5 * fwidth(phase), 1.0), place = fract(phase);
    float edge = max(smoothstep(1.0 - soft, 1.0, place), 0.0);
    float shade = smoothstep(0.0, 0.62, place) * (1.0 - edge);
    return mix(mix(0.55, 1.06, shade), 0.9, smoothstep(0.35, 1.0, soft));
}

// Two windows, one on either side of the eye, stand on every round part as stripes along it.
float windows(vec3 n) {
    float round_ = length(n.xy);
    vec2 from = (vec2(dot(n, right) / max(round_, 1e-4)) + vec2(0.40, -0.62)) / vec2(0.17, 0.10);
    vec2 seen = exp(-from * from);
    return smoothstep(0.1, 0.7, round_) * (seen.x + 0.45 * seen.y);
}

void main() {
    vec3 n = normalize(normal);
    float turned = 1.0 - abs(dot(n, eye));
    float rim = turned * turned;
    vec3 base = inks[kind];
    if (kind == 0u && abs(n.z) < 0.98) base *= fluted();
    float mirrored = pow(max(dot(n, halfway), 0.0), 36.0);
    float gloss = kind == 2u ? 0.20 : 0.34;
    float mirror = gloss * max(mirrored, windows(n));
    vec3 lit = base * (strength.x + strength.y * max(dot(n, light), 0.0)) + mirror * mix(vec3(1.0), base, 0.35);
    lit = mix(lit, edge, 0.55 * smoothstep(0.35, 0.95, rim));
    colour = vec4(lit, share * min(mix(alphas[kind].x, alphas[kind].y, rim) + 0.8 * mirror, 1.0));
}
