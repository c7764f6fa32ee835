#version 330
// A picture over another one of another size: colours between pixels are mixed, depths are those of the nearest pixel.
uniform sampler2D picture;
uniform sampler2D depths;
#ifdef LINES
uniform sampler2D finer;      // with more lines of sight, where `uneven` says so
uniform sampler2D uneven;
uniform sampler2D finer_depths;
uniform float fold;           // depth of half a pixel: metal bent by as much within one has an edge there
uniform vec3 edge;            // of fine lines along edges, and their share of the colour
uniform float line_share;
#endif
uniform vec2 size;            // of what is painted, px
out vec4 colour;

#ifdef LINES
float depth_at(ivec2 at) {
    return texelFetch(finer_depths, clamp(at, ivec2(0), textureSize(finer_depths, 0) - 1), 0).r;
}

// How far the metal at a line of sight stands out of what those next to it meet, in folds: depths of a plane are those
// of its neighbours in the mean. Where a neighbour met nothing there is no telling.
float stands_out(ivec2 at) {
    float own = depth_at(at), most = 0.0;
    for (int k = 0; k < 2; ++k) {
        ivec2 aside = k == 0 ? ivec2(1, 0) : ivec2(0, 1);
        float one = depth_at(at - aside), other = depth_at(at + aside);
        if (max(max(own, one), other) < 1.0) most = max(most, one + other - 2.0 * own);
    }
    return most / fold;
}
#endif

void main() {
    vec2 at = gl_FragCoord.xy / size;
    colour = vec4(texture(picture, at).rgb, 1.0);
#ifdef LINES
    // a loop, as a software renderer goes through the body of an `if` for all pixels, but through none of a loop's
    int more = texture(uneven, at).r > 0.5 ? 4 : 0;
    float lines = 0.0;
    for (int k = 0; k < more; ++k) {
        colour.rgb = texture(finer, at).rgb;
        lines += smoothstep(0.3, 0.9, stands_out(2 * ivec2(gl_FragCoord.xy) + ivec2(k & 1, k >> 1)));
    }
    colour.rgb = mix(colour.rgb, edge, 0.25 * line_share * lines);
#endif
    gl_FragDepth = texture(depths, at).r;
}
