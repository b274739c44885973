// Rays through the two trees of bounding boxes, of triangles that never move and of all others. It is a part of
// rays/trace.glsl, which is what shaders include, on devices, and of the project's own tracer on the host
// (framework/scene/rays/ray_tracer_bvh.cpp).
#ifndef FOVEA_RAYS_BVH_GLSL
#define FOVEA_RAYS_BVH_GLSL

SCENE_TEXELS(11, uvec4, rayNodes);  // BvhNode
SCENE_TEXELS(12, uvec4, rayTriangles);  // leaf by leaf: vertices, triangle and kRayHoles

// ---- Boxes and triangles -----------------------------------------------------------------------------------------

// A ray with what the tests of boxes and triangles need.
struct PreparedRay {
  vec3 origin, inverse;
  float near, far;
  int longest;  // axis along which the direction is longest; it becomes the third
  vec3 shear;   // of the direction to that axis
};

// The components of v in cyclic order, so that `third` comes last.
vec3 permuted(vec3 v, int third) {
  return third == 0 ? vec3(v.y, v.z, v.x) : third == 1 ? vec3(v.z, v.x, v.y) : v;
}

// The ray, prepared.
PreparedRay prepare(Ray ray) {
  PreparedRay r;
  r.origin = ray.origin;
  // No component is 0, so that a ray within a face of a box is inside.
  vec3 d = ray.direction, least = vec3(kLeastDirection);
  r.inverse = 1.0 / mix(mix(least, -least, lessThan(d, vec3(0.0))), d, greaterThan(abs(d), least));
  r.near = ray.near;
  r.far = ray.far;
  vec3 a = abs(d);
  r.longest = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  vec3 p = permuted(d, r.longest);
  r.shear = vec3(vec2(p), 1.0) / p.z;
  return r;
}

// Whether the ray meets the box. entry: distance at which it enters. The far side is moved out by the rounding errors
// (Ize, "Robust BVH Ray Traversal", JCGT 2013), here enough for quotients that are off by 2.5 units in the last place.
bool enters(PreparedRay r, vec3 low, vec3 high, OUT(float) entry) {
  vec3 a = (low - r.origin) * r.inverse, b = (high - r.origin) * r.inverse;
  vec3 nearer = min(a, b), farther = max(a, b) * (1.0 + 8.0 * 1.1920929e-7);
  entry = max(max(nearer.x, nearer.y), max(nearer.z, r.near));
  return entry <= min(min(farther.x, farther.y), min(farther.z, r.far));
}

// Whether the ray meets the triangle a, b, c; distance_: as in RayHit; weights: of b and c. Watertight (Woop, Benthin
// and Wald, JCGT 2013): `precise`, so that two triangles compute the same for the edge that they share. On the edge
// itself both are hit.
bool meets(PreparedRay r, vec3 a, vec3 b, vec3 c, OUT(float) distance_, OUT(vec2) weights) {
  a = permuted(a - r.origin, r.longest);
  b = permuted(b - r.origin, r.longest);
  c = permuted(c - r.origin, r.longest);
  vec2 shear = vec2(r.shear);
  precise vec2 a2 = vec2(a) - shear * a.z, b2 = vec2(b) - shear * b.z, c2 = vec2(c) - shear * c.z;
  precise float u = c2.x * b2.y - c2.y * b2.x, v = a2.x * c2.y - a2.y * c2.x, w = b2.x * a2.y - b2.y * a2.x;
  float determinant = u + v + w;
  distance_ = r.shear.z * (u * a.z + v * b.z + w * c.z) / determinant;
  weights = vec2(v, w) / determinant;
  bool inside = min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0;
  return inside && determinant != 0.0 && distance_ > r.near && distance_ < r.far;
}

// Tests the triangles of a leaf, `count` of them from `first` on. Each hit shortens the ray.
void meetLeaf(uint first, uint count, INOUT(PreparedRay) r, INOUT(RayHit) hit) {
  for (uint i = first; i < first + count; ++i) {
    uvec4 triangle = texelOf(rayTriangles, int(i));
    float distance_;
    vec2 weights;
    bool met = meets(r, scenePosition(triangle.x), scenePosition(triangle.y), scenePosition(triangle.z), distance_,
                     weights);
    uint index = triangle.w & ~kRayHoles;
    if (met && triangle.w != index) met = solidAt(index, triangle, weights);
    if (!met) continue;
    r.far = distance_;
    hit = RayHit(index, distance_, weights);
  }
}

// ---- The tree ----------------------------------------------------------------------------------------------------

// The nearest hit, or the first one found if `any` suffices. Of two children whose boxes the ray enters, the nearer
// comes first. Nodes are named by their first child; 0 stands for an empty tree.
RayHit trace(Ray ray, bool any) {
  PreparedRay r = prepare(ray);
  RayHit hit = RayHit(kNoTriangle, ray.far, vec2(0.0));
  uint stack[kBvhDepth];
  uint size = 0u, children = kBvhStill;
  for (bool more = true; more;) {
    uint next = 0u;
    float nextEntry = 0.0, entry;
    for (uint child = children; child < children + 2u; ++child) {
      uvec4 low = texelOf(rayNodes, int(2u * child)), high = texelOf(rayNodes, int(2u * child + 1u));
      if (!enters(r, uintBitsToFloat(uvec3(low)), uintBitsToFloat(uvec3(high)), entry)) continue;
      if (high.w > 0u) {
        meetLeaf(low.w, high.w, r, hit);
        continue;
      }
      uint later = next != 0u && entry >= nextEntry ? low.w : next;
      if (next == 0u || entry < nextEntry) {
        next = low.w;
        nextEntry = entry;
      }
      if (later != 0u) stack[size++] = later;
    }
    if (any && hit.triangle != kNoTriangle) break;
    more = next != 0u || size > 0u;
    if (next == 0u && more) next = stack[--size];
    children = next;
  }
  return hit;
}

#endif
