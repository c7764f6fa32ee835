#version 330
// A picture over another one of another size: colours between pixels are mixed, depths are those of the nearest pixel.
uniform sampler2D picture;
uniform sampler2D depths;
uniform sampler2D finer;      // with more lines of sight, where `uneven` says so
uniform sampler2D uneven;
uniform int has_finer;
uniform vec2 size;            // of what is painted, px
out vec4 colour;

void main() {
    vec2 at = gl_FragCoord.xy / size;
    colour = vec4(texture(picture, at).rgb, 1.0);
    if (has_finer == 1 && texture(uneven, at).r > 0.5) colour.rgb = texture(finer, at).rgb;
    gl_FragDepth = texture(depths, at).r;
}
