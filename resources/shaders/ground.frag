#version 330
// The ground that the stock lies on, darkened softly where light does not reach below it. Places are mm.
uniform vec3 eye;             // of the pixel at the lower left
uniform vec3 right;           // a pixel further
uniform vec3 up;
uniform vec3 away;            // from the eye, length 1
uniform float ground_z;
uniform vec4 sides;           // x0, y0, x1, y1 of what stands on it
uniform float blur;           // how far a border's shadow reaches on either side of it
uniform vec3 canvas;
uniform float dark;           // share of the canvas' light that is missing in the midst of the shadow
uniform sampler2D uneven;     // of the picture with a line of sight in a pixel: where there may be more between
uniform int finer;            // 1 = this is the picture with two by two, where that is so
out vec4 colour;

void main() {
    if (finer == 1 && texelFetch(uneven, ivec2(gl_FragCoord.xy) / 2, 0).r == 0.0) discard;
    vec3 start = eye + gl_FragCoord.x * right + gl_FragCoord.y * up;
    vec2 at = start.xy + away.xy * ((ground_z - start.z) / away.z);
    vec2 within = smoothstep(sides.xy - blur, sides.xy + blur, at) - smoothstep(sides.zw - blur, sides.zw + blur, at);
    colour = vec4(canvas * (1.0 - dark * within.x * within.y), 1.0);
}
