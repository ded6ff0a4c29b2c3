#include <render/gl.hpp>

namespace sloper::render {

const char* const SURFACE_VERTEX_SHADER = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec4 color_in;
layout(location = 3) in vec4 cloth_in;
layout(location = 4) in vec3 value_in;
uniform mat4 clip;
uniform mat3 turn;
uniform vec3 center;
out vec3 view, normal, color;
out vec4 cloth;
out vec4 light; // sky, key, map value, whether there is one
void main() {
  gl_Position = clip * vec4(position, 1.0);
  view = turn * (position - center);
  normal = turn * normal_in;
  color = color_in.rgb;
  cloth = cloth_in;
  light = vec4(color_in.a, value_in.y, value_in.x, value_in.z);
})";

// Two-sided. Sky from above, a warm key light from the upper left that throws soft shadows, a cool
// fill from the right, a rim that parts cloth from ground. Map values become eight steps. Cloth is
// woven: slubs along warp and weft from afar, threads near by; each fades before it is finer than a
// pixel. Constants come before it: kind (0 body, 1 cloth, 2 flat, 3 ground shadow), fabric (0
// plain, 1 woven, 2 twill, 3 stripes, 4 checks, 5 print), steps (of a map, 0: none). A processor
// would compute every branch of a uniform for every pixel.
const char* const SURFACE_FRAGMENT_SHADER = R"(
in vec3 view, normal, color;
in vec4 cloth;
in vec4 light;
uniform float eye;    // distance of the viewer from the centre, 0: infinite
uniform vec3 scale[8], no_value;
uniform vec3 accent;
uniform float print_size; // m
uniform sampler2D print;
out vec4 pixel;
float hash(vec2 p) {
  p = fract(p * vec2(0.1031, 0.1197));
  p += dot(p, p.yx + 33.33);
  return fract((p.x + p.y) * p.x);
}
float noise(vec2 p) {
  vec2 i = floor(p), f = p - i;
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
float fade(float width) { return clamp(1.6 - 2.0 * width, 0.0, 1.0); }
vec3 woven(vec3 base, vec2 uv, float pixel_size) {
  if (fabric == 0) return base;
  vec2 slow = uv * 260.0;
  float slub = fade(pixel_size * 260.0 * 0.5) * (noise(slow * vec2(1.0, 0.07)) + noise(slow * vec2(0.07, 1.0)) - 1.0);
  vec3 result = base * (1.0 + (fabric == 1 ? 0.10 : 0.06) * slub);
  float threads = fade(pixel_size * 1250.0);
  if (threads > 0.0) {
    vec2 t = uv * 1250.0;
    float over = fabric == 2 ? step(1.0, mod(floor(t.x) + floor(t.y), 3.0)) : mod(floor(t.x) + floor(t.y), 2.0);
    vec2 bow = sin(3.14159 * fract(t));
    result *= mix(1.0, 0.72 + 0.42 * mix(bow.x, bow.y, over), threads);
  }
  if (fabric == 2) {
    float rib = fract((uv.x + uv.y) * 180.0);
    result *= 1.0 + 0.13 * fade(pixel_size * 180.0) * (smoothstep(0.0, 0.25, rib) - smoothstep(0.5, 0.75, rib) - 0.5);
  }
  float edge = clamp(pixel_size / 0.036, 0.004, 0.5);
  vec2 band = smoothstep(0.25 - edge, 0.25 + edge, abs(fract(uv / 0.036) - 0.5));
  if (fabric == 3) result = mix(result, accent * result / max(base, vec3(0.02)), 0.75 * smoothstep(0.3 - edge, 0.3 + edge, abs(fract(uv.x / 0.014) - 0.5)));
  if (fabric == 4) result = mix(result, accent * result / max(base, vec3(0.02)), 0.42 * (band.x + band.y));
  return result;
}
void main() {
  if (kind == 3) {
    float r = length(cloth.xy);
    pixel = vec4(0.0, 0.0, 0.0, 0.62 * (1.0 - light.x) * (1.0 - smoothstep(0.55, 1.0, r)));
    return;
  }
  vec3 n = normalize(normal);
  vec3 v = eye > 0.0 ? normalize(vec3(0.0, 0.0, eye) - view) : vec3(0.0, 0.0, 1.0);
  bool back = dot(n, v) < 0.0;
  if (back) n = -n;
  float pixel_size = 0.5 * (length(dFdx(cloth.xy)) + length(dFdy(cloth.xy)));
  vec3 base = color;
  if (kind == 1 || kind == 2) {
    if (steps > 0 && light.w >= 0.5) {
      float t = clamp(light.z, 0.0, 0.9999) * 8.0;
      float width = max(fwidth(t), 1e-4), at = fract(t);
      int k = int(t);
      base = scale[k];
      if (k < 7) base = mix(base, scale[k + 1], smoothstep(1.0 - 0.5 * width, 1.0, at) * 0.5);
      if (k > 0) base = mix(base, scale[k - 1], (1.0 - smoothstep(0.0, 0.5 * width, at)) * 0.5);
    } else if (steps > 0) {
      base = no_value;
    } else if (fabric == 5) {
      base = texture(print, vec2(cloth.x, -cloth.y) / print_size).rgb;
    } else if (kind == 1) {
      base = woven(color, cloth.xy, pixel_size);
    }
  }
  vec3 lit;
  if (kind == 2) {
    lit = base;
  } else {
    if (kind == 1) {
      if (back) base *= 0.62;
      base *= 1.0 - 0.22 * exp(-cloth.z / 0.0025); // cloth dips into a seam
      float wide = fwidth(cloth.w) + 1e-6;
      if (steps == 0 && !back) { // the hem's stitching
        float line = 1.0 - smoothstep(0.0, max(wide, 0.0008), abs(cloth.w - 0.011));
        base *= 1.0 - 0.30 * line * clamp(0.006 / wide - 0.6, 0.0, 1.0);
      }
    }
    float sky = 0.5 + 0.5 * n.y;
    float open = back ? 0.55 : light.x, reach = back ? 0.3 : light.y;
    vec3 key = vec3(1.0, 0.965, 0.91) * max(dot(n, normalize(vec3(-0.62, 0.60, 0.50))), 0.0) * reach;
    vec3 fill = vec3(0.80, 0.90, 1.0) * max(dot(n, normalize(vec3(0.8, 0.1, 0.6))), 0.0);
    float graze = 1.0 - abs(dot(n, v));
    float rim = graze * graze * graze;
    lit = base * (open * (0.27 + 0.25 * sky) + 0.86 * key + (0.3 + 0.7 * open) * 0.13 * fill);
    lit += (kind == 1 ? 0.10 : 0.05) * rim * open * (0.35 + base);
    vec3 h = normalize(normalize(vec3(-0.62, 0.60, 0.50)) + v);
    if (kind == 0) lit += vec3(0.045) * pow(max(dot(n, h), 0.0), 18.0) * reach;
  }
  vec3 srgb = mix(lit * 12.92, 1.055 * pow(max(lit, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, lit));
  pixel = vec4(clamp(srgb, 0.0, 1.0), 1.0);
})";

// A segment becomes a rectangle of `width` pixels that lies a little nearer to the viewer than the
// surface.
const char* const LINE_VERTEX_SHADER = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 other;
layout(location = 2) in vec4 color_in;
uniform mat4 clip;
uniform vec2 half_size; // of the picture, pixels
uniform float width, nearer;
out vec3 color;
void main() {
  vec4 p = clip * vec4(position, 1.0), q = clip * vec4(other, 1.0);
  vec2 d = (q.xy / q.w - p.xy / p.w) * half_size;
  float l = length(d);
  d = l > 1e-6 ? d / l : vec2(1.0, 0.0);
  p.xy += 0.5 * width * (color_in.a * vec2(-d.y, d.x) - 0.3 * d) / half_size * p.w;
  p.z -= nearer * p.w;
  gl_Position = p;
  color = color_in.rgb;
})";

const char* const LINE_FRAGMENT_SHADER = R"(#version 330
in vec3 color;
out vec4 pixel;
void main() { pixel = vec4(color, 1.0); }
)";

} // namespace sloper::render
