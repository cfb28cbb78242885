// How a body looks in the real room: its shape, how much of it an eye's depth leaves to be seen, and its shadow.

const VERTEX_HEAD = `#version 300 es
  precision highp float;
  layout(location = 0) in vec4 a_base;
  layout(location = 1) in vec3 a_normal;
  layout(location = 2) in vec4 i_place;
  layout(location = 3) in vec4 i_turn;
  layout(location = 4) in vec4 i_scale;
  layout(location = 5) in vec4 i_color;
  uniform mat4 u_clip_from_world;
  vec3 turn(vec4 q, vec3 v) { vec3 t = 2.0 * cross(q.xyz, v); return v + q.w * t + cross(q.xyz, t); }`;

export const BODY_VERTEX = `${VERTEX_HEAD}
  out vec3 v_world, v_normal, v_color;
  void main() {
    vec3 p = a_base.xyz * i_scale.xyz + vec3(0.0, a_base.w * i_scale.w, 0.0);
    v_world = i_place.xyz + turn(i_turn, p);
    v_normal = turn(i_turn, a_normal / i_scale.xyz);
    v_color = i_color.rgb;
    gl_Position = u_clip_from_world * vec4(v_world, 1.0);
  }`;

// A box about the body in which its shadow lies.
export const SHADOW_VERTEX = `${VERTEX_HEAD}
  out vec3 v_world;
  flat out vec4 v_body;
  void main() {
    v_world = i_place.xyz + 4.4 * i_place.w * a_base.xyz;
    v_body = i_place;
    gl_Position = u_clip_from_world * vec4(v_world, 1.0);
  }`;

// The eye's depth. metres(): 0 = none. lookup(): where a world point is in the buffer, in texels; z ahead of the depth view.
const DEPTH = `#version 300 es
  precision highp float;
  precision highp sampler2D;
  uniform sampler2D u_depth;
  uniform mat4 u_depth_from_world, u_world_from_depth;
  uniform vec4 u_lens;          // projection's 0, 5, 8, 9
  uniform vec3 u_buffer[2];     // rows of normDepthBufferFromNormView
  uniform vec3 u_raw;           // metres of a raw unit; near, near / far of an OpenGL depth, or 0
  uniform vec2 u_size;          // 0: this eye has no depth
  float metres(ivec2 at) {
    float v = texelFetch(u_depth, clamp(at, ivec2(0), ivec2(u_size) - 1), 0).r * u_raw.x;
    return u_raw.y > 0.0 ? (v > 0.0 && v < 1.0 ? u_raw.y / (1.0 - v * (1.0 - u_raw.z)) : 0.0) : v;
  }
  vec3 lookup(vec3 world) {
    vec3 p = (u_depth_from_world * vec4(world, 1.0)).xyz;
    vec2 t = u_lens.xy * p.xy / -p.z;
    vec3 view = vec3(0.5 * (t.x - u_lens.z + 1.0), 0.5 * (1.0 - t.y + u_lens.w), 1.0);
    return vec3(vec2(dot(u_buffer[0], view), dot(u_buffer[1], view)) * u_size - 0.5, -p.z);
  }`;

// How much of a point is seen: of four texels those that have depth, bilinear, each with a ramp of 2 cm; in a hole what
// stands about it.
const SEEN = `
  const float RAMP_M = 0.02;
  float seen(vec3 world) {
    vec3 at = lookup(world);
    if (u_size.x == 0.0 || at.z <= 0.0 || any(lessThan(at.xy, vec2(-1.0))) || any(greaterThan(at.xy, u_size))) return 1.0;
    ivec2 base = ivec2(floor(at.xy));
    vec2 f = at.xy - vec2(base);
    float sum = 0.0, weight = 0.0;
    for (int k = 0; k < 4; k++) {
      ivec2 d = ivec2(k & 1, k >> 1);
      float z = metres(base + d);
      vec2 w = mix(1.0 - f, f, vec2(d));
      if (z > 0.0) { sum += w.x * w.y * smoothstep(-RAMP_M, 0.0, z - at.z); weight += w.x * w.y; }
    }
    for (int k = 0; k < 16 && weight < 0.05; k++) { // a hole: rings of 3 and 7 texels
      float a = 0.785398 * float(k);
      float z = metres(base + ivec2(round((k < 8 ? 3.0 : 7.0) * vec2(cos(a), sin(a)))));
      if (z > 0.0) { sum += 0.1 * smoothstep(-RAMP_M, 0.0, z - at.z); weight += 0.1; }
    }
    return weight > 0.0 ? sum / weight : 1.0;
  }`;

export const BODY_FRAGMENT = `${DEPTH}${SEEN}
  in vec3 v_world, v_normal, v_color;
  uniform vec3 u_eye;
  out vec4 color;
  void main() {
    float alpha = seen(v_world);
    if (alpha < 0.004) discard;
    vec3 n = normalize(v_normal), e = normalize(u_eye - v_world), light = normalize(vec3(0.35, 0.9, 0.3));
    float sky = 0.5 + 0.5 * n.y, sun = max(dot(n, light), 0.0), gleam = pow(max(dot(n, normalize(e + light)), 0.0), 40.0);
    vec3 shade = pow(v_color, vec3(2.2)) * (0.18 + 0.32 * sky + 0.55 * sun) + 0.12 * gleam;
    color = vec4(pow(shade, vec3(1.0 / 2.2)) * alpha, alpha);
  }`;

// The real point behind this pixel: how near is it below the body?
export const SHADOW_FRAGMENT = `${DEPTH}
  in vec3 v_world;
  flat in vec4 v_body;
  uniform vec3 u_eye;
  out vec4 color;
  vec4 real(vec3 world) {
    vec3 at = lookup(world);
    ivec2 base = ivec2(floor(at.xy));
    vec2 f = at.xy - vec2(base);
    float z = 0.0, least = 1e9, most = 0.0;
    for (int k = 0; k < 4; k++) {
      ivec2 d = ivec2(k & 1, k >> 1);
      float m = metres(base + d);
      vec2 w = mix(1.0 - f, f, vec2(d));
      z += w.x * w.y * m; least = min(least, m); most = max(most, m);
    }
    vec3 p = (u_depth_from_world * vec4(world, 1.0)).xyz;
    return vec4((u_world_from_depth * vec4(p * (z / -p.z), 1.0)).xyz, least > 0.0 && most < 1.1 * least ? 1.0 : 0.0);
  }
  void main() {
    if (u_size.x == 0.0) discard;
    vec3 ray = normalize(v_world - u_eye);
    vec4 point = real(u_eye + ray * distance(u_eye, v_body.xyz));
    vec3 way = point.xyz - v_body.xyz;
    float r = v_body.w, below = -way.y / r, aside = length(way.xz) / r;
    // A disc of sky that a ball covers (Inigo Quilez 2006, sphere ambient occlusion), for what lies below.
    float d = length(way) / r;
    float dark = point.w * smoothstep(0.0, 0.6, below) * 0.75 * below / max(d * d * d, 1.0) * smoothstep(2.1, 1.2, aside);
    if (dark < 0.004) discard;
    color = vec4(0.0, 0.0, 0.0, dark);
  }`;
