#version 330
// Metal in the light: the normal of every pixel comes from the heights themselves, however coarse the triangles are.
uniform sampler2D heights;
uniform sampler2D values;     // per cell: place in the palette, 0 to 1; NaN = stock; 2 = out of reach
uniform sampler2D palette;
uniform vec3 corner;
uniform float floor_z;
uniform vec3 light;           // towards the light, length 1
uniform vec3 eye;             // towards the eye, length 1
uniform vec3 stock;           // colours, 0 to 1
uniform vec3 hatch;
uniform vec4 strength;        // of the ambient light, of the light, of its mirror image, of the shade in corners
uniform vec2 relief;          // how many times a small slope is made steeper, and up to which slope
uniform int face;             // 0 = metal, 1 = face of the section
in vec3 place;
flat in vec3 side;
out vec4 colour;

vec2 count = vec2(textureSize(heights, 0));

float height(vec2 cell, float level) {
    return textureLod(heights, cell / count, level).r;
}

vec3 normal_at(vec2 cell, float width) {
    float level = max(log2(width), 0.0);
    float reach = 0.5 * max(width, 1.0);
    vec2 slope = vec2(height(cell + vec2(reach, 0.0), level) - height(cell - vec2(reach, 0.0), level),
                      height(cell + vec2(0.0, reach), level) - height(cell - vec2(0.0, reach), level)) / (2.0 * reach * corner.z);
    slope *= 1.0 + (relief.x - 1.0) / (1.0 + dot(slope, slope) / (relief.y * relief.y));
    return normalize(vec3(-slope, 1.0));
}

float shade_in_corners(vec2 cell) {
    float shade = 0.0;
    for (float level = 3.0; level < 6.0; level += 1.0)
        shade += clamp((height(cell, level) - place.z) / (exp2(level) * corner.z), 0.0, 1.0);
    return 1.0 - strength.w * min(shade, 1.0);
}

bool striped(float step, float width) {
    return mod(gl_FragCoord.x + gl_FragCoord.y, step) < width;
}

vec3 base_colour(vec2 cell) {
    float value = texelFetch(values, clamp(ivec2(cell), ivec2(0), ivec2(count) - 1), 0).r;
    if (isnan(value)) return stock;
    if (value > 1.5) return striped(8.0, 2.5) ? hatch : mix(stock, hatch, 0.45);
    return texture(palette, vec2(value, 0.5)).rgb;
}

void main() {
    vec2 cell = (place.xy - corner.xy) / corner.z;
    bool wall = side != vec3(0.0);
    if (!wall && place.z <= floor_z + 1e-4) discard;
    if (side.z < 0.0 && height(floor(cell) + 0.5, 0.0) <= floor_z) discard;
    vec2 across = max(abs(dFdx(cell)), abs(dFdy(cell)));
    vec3 normal = wall ? side : normal_at(cell, max(across.x, across.y));
    vec3 base = wall ? stock : base_colour(cell);
    if (face == 1) base = striped(10.0, 1.5) ? mix(base, hatch, 0.55) : base;
    float lit = max(dot(normal, light), 0.0);
    float mirrored = pow(max(dot(normal, normalize(light + eye)), 0.0), 40.0);
    float shade = wall ? 1.0 : shade_in_corners(cell);
    colour = vec4(base * (strength.x + strength.y * lit) * shade + strength.z * mirrored * shade, 1.0);
}
