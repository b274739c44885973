// Projections of the lights' shadow maps, one invocation per light.
#include "scene/scene.glsl"
#include "vpls/paraboloid.glsl"
#include "vpls/shadow.glsl"

layout(local_size_x = 64) in;

layout(std430) writeonly buffer MapsViews { ShadowView view[]; } mapsViews;

layout(push_constant) uniform Constants { int size; };

const float kGuard = 3.0;           // margin in texels, for the reach of a filter
const float kMaxSpotAngle = 1.483;  // 85 degrees, as a plane cannot show a half space; points outside are not shadowed

float guarded() { return float(size) / max(float(size) - 2.0 * kGuard, 1.0); }

// Builds a matrix from its rows.
mat4 fromRows(vec4 x, vec4 y, vec4 z, vec4 w) { return transpose(mat4(x, y, z, w)); }

// Perspective from `eye` along axes[2]; depth = near / distance along the axis.
ShadowView perspective(vec3 eye, mat3 axes, float tanHalf, float near) {
  float t = tanHalf * guarded();
  vec3 at = -(eye * axes);
  mat4 worldToClip =
      fromRows(vec4(axes[0], at.x) / t, vec4(axes[1], at.y) / t, vec4(0, 0, 0, near), vec4(axes[2], at.z));
  float texel = 2.0 * t / float(size);
  return ShadowView(worldToClip, axes[0], texel, axes[1], texel, 0.0, 1e-4, near, 0.0);
}

// Orthographic around the whole scene, so that everything that may cast a shadow is inside.
ShadowView orthographic(mat3 axes) {
  vec3 lo = vec3(3e38), hi = vec3(-3e38);
  for (int i = 0; i < 8; ++i) {
    vec3 corner = mix(frame.boundsMin, frame.boundsMax, bvec3(i & 1, i & 2, i & 4));
    lo = min(lo, corner * axes);
    hi = max(hi, corner * axes);
  }
  vec3 centre = 0.5 * (lo + hi), half_ = 0.5 * (hi - lo);
  // A flat scene gets a depth of which the bias is more than the rounding of positions.
  half_ = max(half_, 1e-2 * max(half_.x, max(half_.y, half_.z))) + 1e-6;
  half_.xy *= guarded();
  half_.z *= 1.001;
  mat4 worldToClip = fromRows(vec4(axes[0], -centre.x) / half_.x, vec4(axes[1], -centre.y) / half_.y,
                              vec4(-0.5 * axes[2], 0.5 * (centre.z + half_.z)) / half_.z, vec4(0, 0, 0, 1));
  return ShadowView(worldToClip, axes[0], 2.0 * half_.x / float(size), axes[1], 2.0 * half_.y / float(size), 1e-5, 0.0,
                    0.5 / half_.z, 0.0);
}

// Axes around a direction for the tightest fit of the scene's box: the smallest rectangle around a convex outline has
// a side along one of its edges, and the edges of a box run along the axes of the world.
mat3 tightAxes(vec3 direction) {
  vec3 extent = frame.boundsMax - frame.boundsMin;
  mat3 best = orthonormalFrame(direction);
  float least = 3e38;
  for (int i = 0; i < 3; ++i) {
    vec3 edge = vec3(equal(ivec3(i), ivec3(0, 1, 2)));
    vec3 right = edge - direction * dot(edge, direction);
    if (dot(right, right) < 1e-6) continue;  // seen end-on
    right = normalize(right);
    vec3 up = cross(direction, right);
    float area = dot(abs(right), extent) * dot(abs(up), extent);
    if (area < least) {
      least = area;
      best = mat3(right, up, direction);
    }
  }
  return best;
}

mat3 cubeAxes(uint face) {
  vec3 axis = vec3(equal(uvec3(face / 2u), uvec3(0u, 1u, 2u))) * ((face & 1u) == 0u ? 1.0 : -1.0);
  return mat3(axis.yzx, axis.zxy, axis);
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= frame.lightCount) return;
  LightRecord light = lights[index];
  uint layer = light.firstShadowLayer;
  uint type = light.type;
  // Close enough to the light to lose nothing relevant; as depth is reversed, this costs no precision.
  float near = 1e-4 * max(distance(frame.boundsMin, frame.boundsMax), 1e-3);
  if (type == kLightDirectional) {
    mapsViews.view[layer] = orthographic(tightAxes(light.direction));
  } else if (type == kLightSpot) {
    float angle = min(acos(clamp(light.cosOuter, -1.0, 1.0)), kMaxSpotAngle);
    mapsViews.view[layer] = perspective(light.position, orthonormalFrame(light.direction), tan(angle), near);
  } else {
    for (uint face = 0u; face < 6u; ++face)
      mapsViews.view[layer + face] = perspective(light.position, cubeAxes(face), 1.0, near);
  }
}
