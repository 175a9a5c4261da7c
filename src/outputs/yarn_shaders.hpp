// GLSL of the yarn renderer.
#pragma once

namespace loopwright::shaders {

inline constexpr const char* yarn_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 along;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 tangent;
layout(location = 4) in vec4 colour;
layout(location = 5) in vec3 offset;
uniform mat4 view_projection;
uniform mat4 shadow_matrix;
uniform float shadow_offset;    // along the normal, in d: keeps a surface out of its own shadow
out vec3 world;
out vec3 shadow_place;
out vec3 surface_normal;
out vec3 surface_tangent;
out vec3 yarn_place;
out vec4 yarn_colour;
void main() {
  world = position + offset;
  surface_normal = normal;
  surface_tangent = tangent;
  yarn_place = along;
  yarn_colour = colour;
  shadow_place = (shadow_matrix * vec4(world + normal * shadow_offset, 1)).xyz * 0.5 + 0.5;
  gl_Position = view_projection * vec4(world, 1);
}
)";

inline constexpr const char* yarn_fragment = R"(#version 330 core
in vec3 world;
in vec3 shadow_place;
in vec3 surface_normal;
in vec3 surface_tangent;
in vec3 yarn_place;
in vec4 yarn_colour;
uniform sampler2DShadow shadow_map;
uniform float shadow_strength;
uniform float shadow_blur;      // radius of the soft edge, in texture coordinates
uniform vec3 to_light, to_sky, to_eye, eye;   // unit vectors; eye: a perspective camera's place
uniform float perspective;
uniform float plies, twist;
out vec4 result;

const float pi = 3.14159265;

float hash(vec2 p) {
  vec3 q = fract(vec3(p.xyx) * 0.1031);
  q += dot(q, q.yzx + 33.33);
  return fract((q.x + q.y) * q.z);
}

// Value noise that repeats after `period` whole cells in both directions.
float noise(vec2 p, vec2 period) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  vec2 a = mod(i, period), b = mod(i + 1.0, period);
  return mix(mix(hash(a), hash(vec2(b.x, a.y)), f.x), mix(hash(vec2(a.x, b.y)), hash(b), f.x), f.y) - 0.5;
}

const vec2 spread[9] = vec2[9](vec2(0.0, 0.0), vec2(0.52, 0.31), vec2(-0.29, 0.55), vec2(-0.6, -0.2),
                               vec2(0.18, -0.62), vec2(0.95, -0.25), vec2(0.1, 0.98), vec2(-0.93, 0.36),
                               vec2(-0.42, -0.9));
float lit() {
  if (shadow_strength <= 0.0) return 1.0;
  float sum = 0.0;
  for (int k = 0; k < 9; ++k) sum += texture(shadow_map, vec3(shadow_place.xy + spread[k] * shadow_blur, shadow_place.z));
  return mix(1.0, sum / 9.0, shadow_strength);
}

void main() {
  vec3 n = normalize(surface_normal), t = normalize(surface_tangent), b = cross(t, n);
  float cap = step(0.5, abs(dot(n, t)));   // a cut end: no plies run over it

  // Place across the ply under this point: f runs from -1 in one groove over 0 on the crown to 1 in the next.
  float turns = yarn_place.x + twist * yarn_place.y;
  float ply = plies * turns;
  float size = fwidth(plies * yarn_place.x) + fwidth(plies * twist * yarn_place.y);
  float size_wrapped = min(size, fwidth(ply));
  float detail = (1.0 - smoothstep(0.22, 0.7, size_wrapped)) * (1.0 - cap);
  float f = fract(ply) * 2.0 - 1.0;
  vec3 across = normalize(b + t * (twist * pi));   // on the surface, over the plies (radius 0.5 d)
  float lean = f / sqrt(1.35 - f * f);
  float groove = smoothstep(0.45, 1.0, abs(f));

  // Fibres lie along the yarn (the twist of the plies undoes that of the single): streaks that are long and thin.
  float cells = plies * abs(twist) * 4.0;
  vec2 period = vec2(44.0, floor(yarn_place.z * cells + 0.5));
  vec2 place = vec2(yarn_place.x * 44.0, yarn_place.y * cells);
  float fibre_detail = (1.0 - smoothstep(0.25, 0.8, fwidth(yarn_place.y) * cells)) * detail;
  float fibre = 0.0;
  if (fibre_detail > 0.0) fibre = noise(place, period) + 0.9 * noise(place * vec2(3.0, 2.0), period * vec2(3.0, 2.0));

  vec3 shape = normalize(n + across * (0.62 * lean * detail) + b * (0.28 * fibre * fibre_detail));
  float open = yarn_colour.a * mix(0.9, 1.0 - 0.36 * groove, detail);

  vec3 view = perspective > 0.5 ? normalize(eye - world) : to_eye;
  float key = max((dot(shape, to_light) + 0.18) / 1.18, 0.0) * lit();
  float sky = 0.5 + 0.5 * dot(shape, to_sky);
  float fill = max(dot(shape, view), 0.0);
  float rim = pow(1.0 - max(dot(n, view), 0.0), 3.0);          // loose fibres light up against the edge
  vec3 half_way = normalize(to_light + view);
  float along_half = dot(t, half_way);
  float sheen = pow(max(1.0 - along_half * along_half, 0.0), 24.0) * key;

  vec3 albedo = pow(yarn_colour.rgb, vec3(2.2)) * (1.0 + 0.3 * fibre * fibre_detail);
  vec3 light = vec3(1.0, 0.97, 0.92) * key * 1.04 * mix(1.0, open, 0.6)
             + mix(vec3(0.24, 0.21, 0.19), vec3(0.44, 0.48, 0.54), sky) * open
             + vec3(0.14) * fill * open;
  // light that went through neighbouring yarn takes its colour: deep places are saturated, not grey
  vec3 through = albedo * (1.0 - open) * 0.16;
  vec3 colour = albedo * (light + through) + vec3(0.035) * sheen * open + albedo * rim * 0.18 * open;
  result = vec4(pow(colour, vec3(1.0 / 2.2)), 1.0);
}
)";

// A loose fibre, lit by the light that reaches the surface that it grows from.
inline constexpr const char* hair_fragment = R"(#version 330 core
in vec3 shadow_place;
in vec3 surface_normal;
in vec3 yarn_place;
in vec4 yarn_colour;
uniform sampler2DShadow shadow_map;
uniform float shadow_strength;
uniform vec3 to_light, to_sky;
out vec4 result;
void main() {
  vec3 n = normalize(surface_normal);
  float lit = shadow_strength > 0.0 ? texture(shadow_map, shadow_place) : 1.0;
  // a fibre lets light through, so the side that faces away is not dark
  float key = (0.45 + 0.55 * max(dot(n, to_light), 0.0)) * lit;
  vec3 light = vec3(0.95) * key + mix(0.30, 0.52, 0.5 + 0.5 * dot(n, to_sky)) * yarn_colour.a;
  vec3 colour = pow(yarn_colour.rgb, vec3(2.2)) * light * 1.08;
  result = vec4(pow(colour, vec3(1.0 / 2.2)), 0.5 * (1.0 - 0.8 * yarn_place.x));
}
)";

inline constexpr const char* depth_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 5) in vec3 offset;
uniform mat4 view_projection;
void main() {
  vec3 world = position + offset;
  gl_Position = view_projection * vec4(world, 1);
}
)";

inline constexpr const char* depth_fragment = R"(#version 330 core
void main() {}
)";

// The table under the cloth: nothing but the shadow that falls on it.
inline constexpr const char* table_vertex = R"(#version 330 core
uniform vec3 centre, side, rise;
uniform mat4 view_projection;
uniform mat4 shadow_matrix;
out vec3 shadow_place;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  vec4 world = vec4(centre + corner.x * side + corner.y * rise, 1);
  shadow_place = (shadow_matrix * world).xyz * 0.5 + 0.5;
  gl_Position = view_projection * world;
}
)";

inline constexpr const char* table_fragment = R"(#version 330 core
in vec3 shadow_place;
uniform sampler2DShadow shadow_map;
uniform float shadow_blur;
uniform vec3 background;
out vec4 result;
void main() {
  // a spiral of taps, turned differently at each pixel: what is left of the pattern is a fine grain
  float sum = 0.0, turn = 6.2832 * fract(52.98292 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  for (int k = 0; k < 32; ++k) {
    float angle = 2.399963 * float(k) + turn, radius = sqrt((float(k) + 0.5) / 32.0) * shadow_blur;
    sum += texture(shadow_map, vec3(shadow_place.xy + radius * vec2(cos(angle), sin(angle)), min(shadow_place.z, 0.9999)));
  }
  vec2 inside = step(vec2(0.0), shadow_place.xy) * step(shadow_place.xy, vec2(1.0));
  float shade = (1.0 - sum / 32.0) * inside.x * inside.y;
  result = vec4(background * (1.0 - 0.32 * shade), 1.0);
}
)";

}  // namespace loopwright::shaders
