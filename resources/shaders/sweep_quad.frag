#version 330
// The height of a sweep over a cell, in closed form; the formulas are those of run_kernels.py, which derives them.
uniform vec4 tool;     // radius, flat, fillet, slope of the cone (0 = none), mm
uniform float span;    // radius that the fillet takes, mm
in vec2 cell;
const float NEVER = 3e38;
out float height;

#ifdef ARC
flat in vec2 normal;
flat in vec4 bend;
flat in vec4 from_ends;
flat in vec4 tangents;
#else
flat in vec4 along;
flat in vec2 steps;
flat in vec4 more;
#ifdef BULL
flat in vec4 lines[3];
#endif
#endif

#if !defined(BALL) && !defined(FLAT_END)
float profile(float rho2) {
    float beyond = max(sqrt(rho2) - tool.y, 0.0);
    float rounded = min(beyond, span);
    float h = tool.z - sqrt(max(tool.z * tool.z - rounded * rounded, 0.0)) + tool.w * (beyond - rounded);
    return rho2 <= tool.x * tool.x * 1.0000004 ? h : NEVER;
}
#endif

#ifdef BULL
float nearer(float y, float c) {
    float u = 1.0 + y * y;
    float cube = u * sqrt(u);
    return y + ((c - more.w * y) * cube - more.z * y * u) / (more.z + more.w * cube);
}

float contact(float c) {
    float y = max(max(lines[0].x * c, lines[0].z * c + lines[0].w), max(lines[1].x * c + lines[1].y, lines[1].z * c + lines[1].w));
    y = max(y, max(lines[2].x * c + lines[2].y, lines[2].z * c + lines[2].w));
    return nearer(nearer(nearer(nearer(y, c), c), c), c);
}
#endif

void main() {
#ifdef ARC
    vec2 off = round(cell) * bend.w;
    vec2 d = normal * bend.x + off, p = from_ends.xy + off, e = from_ends.zw + off;
    float w = 2.0 * dot(normal, d) + dot(d, d) * bend.y;
    float gap = w / (1.0 + sqrt(max(1.0 + w * bend.y, 0.0)));
    bool inside = min(dot(p, tangents.xy), -dot(e, tangents.zw)) >= 0.0;
    height = bend.z + profile(inside ? gap * gap : min(dot(p, p), dot(e, e)));
#else
    vec2 off = round(cell);
    float on = dot(steps, off);
    float a = along.x + on, b = along.y + on, c = along.z + steps.x * off.y - steps.y * off.x;
    float s = along.w;
    float q2 = tool.x * tool.x - c * c;
#if defined(BALL)
    float ahead = q2 * more.z;
    bool before = a * abs(a) < ahead, after = b * abs(b) > ahead;
    float root = before ? q2 - a * a : after ? q2 - b * b : q2 * more.w;
    float centre = before ? more.x : after ? more.y : more.x + s * a;
    height = root >= 0.0 && q2 >= 0.0 ? centre - sqrt(root) : NEVER;
#elif defined(FLAT_END)
    float q = sqrt(max(q2, 0.0));
    height = q2 >= 0.0 && min(a + q, q - b) >= 0.0 ? more.x + s * max(a - q, 0.0) : NEVER;
#else
    float c2 = c * c, q = sqrt(max(q2, 0.0)), v = 0.0;
    if (s * tool.x >= 1e-9) {
#if defined(CONE)
        v = max(max(sqrt(max(tool.y * tool.y - c2, 0.0)), more.z * abs(c)), more.w * q);
#elif defined(TAPER)
        float ball = abs(more.w) * sqrt(max(tool.z * tool.z - c2, 0.0));
        v = min(max(more.z * abs(c), more.w < 0.0 ? q : 0.0), q);
        v = c2 + ball * ball <= span * span ? ball : v;
#elif defined(BULL)
        float y = contact(abs(c));
        float y2 = y * y;
        v = (tool.y + more.w * sqrt((1.0 + y2) / (1.0 + s * s))) * sqrt(max(1.0 - s * s * y2, 0.0) / (1.0 + y2));
#endif
        v = min(v, q);
    }
    bool before = a < v, after = b > v;
    float reach = before ? a : after ? b : v;
    height = (before ? more.x : after ? more.y : more.x + s * (a - v)) + profile(c2 + reach * reach);
#endif
#endif
}
