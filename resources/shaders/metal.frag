#version 330
// Metal in the light: every pixel takes its normal from the map of the heights' relief, however coarse the triangles are.
uniform sampler2D relief;     // per cell: x and y of the normal as sign and root, and the light that reaches a corner
uniform sampler2D values;     // per cell: place in the palette
uniform sampler2D palette;    // 256 colours
uniform vec3 corner;
uniform vec3 light;           // towards the light, length 1
uniform vec3 halfway;         // between the light and the eye, length 1
uniform vec3 stock;           // colours, 0 to 1
uniform vec3 hatch;
uniform vec3 edge;            // of fine lines where metal ends
uniform vec3 strength;        // of the ambient light, of the light, of its mirror image
uniform float floor_z;
uniform int face;             // 0 = metal, 1 = face of the section
out vec4 colour;

#ifndef TOP
uniform vec4 hole;            // x0, y0, x1, y1 of what somebody else paints, mm

bool elsewhere(vec2 at) {
    return all(greaterThan(at, hole.xy)) && all(lessThan(at, hole.zw));
}
#endif

bool striped(float step, float width) {
    return mod(gl_FragCoord.x + gl_FragCoord.y, step) < width;
}

vec3 lit(vec3 base, vec3 normal, float open) {
    float mirrored = max(dot(normal, halfway), 0.0);
    mirrored *= mirrored;
    mirrored *= mirrored;
    mirrored *= mirrored;
    mirrored *= mirrored;
    return open * (base * (strength.x + strength.y * max(dot(normal, light), 0.0)) + strength.z * mirrored * mirrored);
}

#if defined(TOP) || defined(TOP_CLIPPED)
in vec2 cell;
in float level;
uniform ivec2 last_cell;
uniform int stride;
uniform sampler2D heights;

// A wall belongs to whoever cut the lower of the cells that it stands between.
ivec2 foot_of_wall(ivec2 here) {
    ivec2 found = here;
    float lowest = texelFetch(heights, here, 0).r;
    for (int k = 0; k < 9; ++k) {
        ivec2 near = clamp(here + (ivec2(k % 3, k / 3) - 1) * stride, ivec2(0), last_cell);
        float z = texelFetch(heights, near, 0).r;
        if (z < lowest) { lowest = z; found = near; }
    }
    return found;
}

vec2 aside_of(vec2 map) {
    vec2 root = map * (255.0 / 127.0) - (128.0 / 127.0);
    return root * abs(root);
}

// Whether the triangle is a wall: it rises over so many cells as nothing does that was not cut by a tool's side.
bool wall() {
    vec3 across = vec3(dFdx(cell), dFdx(level)), along = vec3(dFdy(cell), dFdy(level));
    vec3 square = cross(across, along);
    return abs(square.z) < 0.35 * length(square);
}

// Which way a wall faces, and the light there: what its cells say, and those a little way along it; one of them alone
// knows only steps.
vec3 facing(ivec2 here) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 25; ++k) {
        ivec2 near = clamp(here + (ivec2(k % 5, k / 5) - 2) * 2, ivec2(0), last_cell);
        vec3 map = texelFetch(relief, near, 0).rgb;
        vec2 aside = aside_of(map.xy);
        sum += vec3(aside * smoothstep(0.3, 0.7, length(aside)), map.z / 25.0);
    }
    return vec3(dot(sum.xy, sum.xy) > 0.0 ? normalize(sum.xy) : vec2(0.0), sum.z);
}

// How much of an edge a pixel is: metal that ends within a pixel, where it falls off steeply.
float rim(ivec2 here) {
    vec2 reach = max(fwidth(cell), vec2(1.0));
    float z = texelFetch(heights, here, 0).r, fall = 0.0;
    for (int k = 0; k < 4; ++k) {
        ivec2 aside = ivec2((k < 2 ? vec2(reach.x, 0.0) : vec2(0.0, reach.y)) * (k % 2 == 0 ? 1.0 : -1.0));
        fall = max(fall, z - texelFetch(heights, clamp(here + aside, ivec2(0), last_cell), 0).r);
    }
    return smoothstep(2.0, 4.0, fall / (corner.z * max(reach.x, reach.y)));
}

void main() {
#ifdef TOP_CLIPPED
    if (elsewhere(corner.xy + cell * corner.z)) discard;
#endif
    vec3 map = texture(relief, cell / vec2(last_cell + 1)).rgb;
    vec2 aside = aside_of(map.xy);
    ivec2 here = clamp(ivec2(cell), ivec2(0), last_cell);
    float line = 0.0;
    if (wall()) {
        vec3 faces = facing(here);
        if (faces.xy != vec2(0.0)) aside = 0.999 * faces.xy;
        map.z = faces.z;
        here = foot_of_wall(here);
    } else {
        line = 0.4 * rim(here);
    }
    vec3 normal = vec3(aside, sqrt(max(1.0 - dot(aside, aside), 0.0)));
    int number = int(texelFetch(values, here, 0).r * 255.0 + 0.5);
    vec3 base = texelFetch(palette, ivec2(number, 0), 0).rgb;
    if (number == 254 && striped(8.0, 2.5)) base = hatch;
    colour = vec4(mix(lit(base, normal, map.z), edge, line), 1.0);
}
#elif defined(UNDERSIDE)
in vec3 place;
flat in vec3 side;
uniform sampler2D heights;

void main() {
    if (elsewhere(place.xy)) discard;
    ivec2 cell = ivec2((place.xy - corner.xy) / corner.z);
    if (texelFetch(heights, clamp(cell, ivec2(0), textureSize(heights, 0) - 1), 0).r <= floor_z) discard;
    colour = vec4(lit(stock, side, 1.0), 1.0);
}
#else
in vec3 place;
flat in vec3 side;

void main() {
    if (elsewhere(place.xy - side.xy * corner.z * 0.01)) discard;
    vec3 base = face == 1 && striped(10.0, 1.5) ? mix(stock, hatch, 0.55) : stock;
    colour = vec4(lit(base, side, 1.0), 1.0);
}
#endif
