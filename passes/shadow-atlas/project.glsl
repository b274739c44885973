// Bounds of a triangle in a paraboloid map, and the intersection seen by a texel. All points are in the VPL's frame.
#ifndef FOVEA_SHADOW_ATLAS_PROJECT_GLSL
#define FOVEA_SHADOW_ATLAS_PROJECT_GLSL

// Inclusive range of the texels whose centres may see the triangle; empty if hi < lo.
struct TexelBox {
  vec2 lo, hi;
};
bool isEmpty(TexelBox box) { return box.hi.x < box.lo.x || box.hi.y < box.lo.y; }
float texelCount(TexelBox box) { return (box.hi.x - box.lo.x + 1.0) * (box.hi.y - box.lo.y + 1.0); }

const float kRounding = 2e-5;  // widens boxes by more than the projection's rounding error

TexelBox texelBox(vec2 lo, vec2 hi, float size) {
  float half_ = 0.5 * size;
  return TexelBox(max(ceil(half_ * (lo - kRounding) + (half_ - 0.5)), 0.0),
                  min(floor(half_ * (hi + kRounding) + (half_ - 0.5)), size - 1.0));
}

// An edge appears as an arc of a circle of radius >= 1 (the image of a great circle). Over a chord of length L
// <= 1 the shorter arc rises by at most 1 - sqrt(1 - L^2 / 4) <= 0.134 L^2. `tight` is false if a vertex lies
// far below the horizon or at the VPL, or if the triangle is so large that the edge need not be the shorter
// arc; use clippedBox() then.
TexelBox projectedBox(vec3 a, vec3 b, vec3 c, float size, out bool tight) {
  float la = length(a), lb = length(b), lc = length(c);
  vec2 pa = paraboloidProject(a, la), pb = paraboloidProject(b, lb), pc = paraboloidProject(c, lc);
  vec2 ab = pb - pa, bc = pc - pb, ca = pa - pc;
  float chord2 = max(max(dot(ab, ab), dot(bc, bc)), dot(ca, ca));
  tight = a.z > -0.5 * la && b.z > -0.5 * lb && c.z > -0.5 * lc && chord2 <= 1.0;
  float rise = 0.134 * chord2;
  return texelBox(min(min(pa, pb), pc) - rise, max(max(pa, pb), pc) + rise, size);
}

// Includes the arc between two points of the map, on the image of the great circle whose plane has normal e. It lies
// in the rectangle over its chord as high as its rise, on the side away from the circle's centre e.xy / e.z.
void includeArc(inout vec2 lo, inout vec2 hi, vec2 p, vec2 q, vec3 e) {
  vec2 chord = q - p;
  float quarter = 0.25 * dot(chord, chord);
  float radius2 = dot(e, e) / max(e.z * e.z, 1e-20 * dot(e, e));
  float rise = quarter / (sqrt(radius2) + sqrt(max(radius2 - quarter, 0.0)));
  vec2 across = vec2(-chord.y, chord.x) * (rise * inversesqrt(max(4.0 * quarter, 1e-20)));
  vec2 away = 0.5 * (p + q) * e.z - e.xy;
  bool nearlyHalfCircle = quarter > 0.9 * radius2;  // the side cannot be told because of rounding
  if (dot(across, away) * e.z < 0.0) across = -across;
  lo = min(lo, min(min(p, q), min(p, q) + across));
  hi = max(hi, max(max(p, q), max(p, q) + across));
  if (nearlyHalfCircle) {
    lo = min(lo, min(p, q) - across);
    hi = max(hi, max(p, q) - across);
  }
}

// End points on the map of an edge clipped against the horizon plane z = 0. Returns false if it is entirely below.
bool clippedEdge(vec3 a, vec3 b, out vec2 p, out vec2 q) {
  vec3 cut = a + (b - a) * (a.z / (a.z - b.z));
  vec2 rim = cut.xy / max(length(cut.xy), 1e-30);
  p = a.z > 0.0 ? paraboloidProject(a, length(a)) : rim;
  q = b.z > 0.0 ? paraboloidProject(b, length(b)) : rim;
  return a.z > 0.0 || b.z > 0.0;
}

// The box of any triangle, clipped at the horizon.
TexelBox clippedBox(vec3 a, vec3 b, vec3 c, float size) {
  vec2 lo = vec2(2.0), hi = vec2(-2.0), p, q;
  vec2 rim[2] = vec2[2](vec2(0.0), vec2(0.0));  // where the triangle's edges leave and enter the hemisphere
  vec3 from[3] = vec3[3](a, b, c), to[3] = vec3[3](b, c, a);
  for (int i = 0; i < 3; ++i) {
    if (clippedEdge(from[i], to[i], p, q)) {
      includeArc(lo, hi, p, q, cross(from[i], to[i]));
      if (!(from[i].z > 0.0)) rim[0] = p;
      if (!(to[i].z > 0.0)) rim[1] = q;
    }
  }
  if (!(a.z > 0.0 && b.z > 0.0 && c.z > 0.0)) includeArc(lo, hi, rim[0], rim[1], vec3(0.0, 0.0, 1.0));
  return texelBox(clamp(lo, -1.0, 1.0), clamp(hi, -1.0, 1.0), size);
}

// The planes through the VPL and the edges, and the triangle's own plane n.x = h.
struct RayTest {
  vec3 e0, e1, e2, n;
  float h;
  float farthest;
};

// a, b, c: in the VPL's frame. n, h: the triangle's plane n.x = h, with n of any length, from world-space
// differences, which suffer least from rounding. A triangle whose plane is closer to the VPL than `epsilon` is the
// surface on which the VPL lies, or is seen edge-on; it blocks nothing.
RayTest rayTest(vec3 a, vec3 b, vec3 c, vec3 n, float h, float epsilon) {
  RayTest r;
  // (b - a) x (b + a) = 2 a x b, without the cancellation. It is exactly opposite for the neighbour across the edge,
  // so no ray slips through between two triangles.
  r.e0 = cross(b - a, b + a);
  r.e1 = cross(c - b, c + b);
  r.e2 = cross(a - c, a + c);
  r.n = n;
  r.h = abs(h) > epsilon * length(n) ? h : 0.0;
  r.farthest = sqrt(max(max(dot(a, a), dot(b, b)), dot(c, c)));
  return r;
}

// Distance to the triangle along the direction through a point of the map, or 0 if it is missed. `weights` are the
// barycentric weights of c, a and b, times a common factor.
float hitDistance(RayTest r, vec2 p, out vec3 weights) {
  float q = dot(p, p);
  vec3 d = vec3(2.0 * p, 1.0 - q);  // length 1 + q
  weights = vec3(dot(r.e0, d), dot(r.e1, d), dot(r.e2, d));
  float least = min(min(weights.x, weights.y), weights.z), most = max(max(weights.x, weights.y), weights.z);
  float t = r.h / dot(r.n, d) * (1.0 + q);
  bool hit = (least >= 0.0 || most <= 0.0) && q < 1.0 && t > 0.0;
  return hit ? min(t, r.farthest) : 0.0;
}

// Returns false if no texel within `reach` of point p of the map, in x and in y, can see the triangle: over the
// square, an edge plane's value v + g.d - e.z |d|^2 keeps its sign.
bool mayHit(RayTest r, vec2 p, float reach) {
  float q = dot(p, p);
  vec3 d = vec3(2.0 * p, 1.0 - q), value, bound;
  vec3 e[3] = vec3[3](r.e0, r.e1, r.e2);
  for (int i = 0; i < 3; ++i) {
    vec3 size = abs(e[i]);
    vec2 g = 2.0 * abs(e[i].xy - e[i].z * p);
    value[i] = dot(e[i], d);
    bound[i] = reach * (g.x + g.y) + 2.0 * reach * reach * size.z + 1e-6 * (size.x + size.y + size.z);
  }
  bool inside = all(greaterThanEqual(value + bound, vec3(0.0))) || all(lessThanEqual(value - bound, vec3(0.0)));
  return inside && sqrt(q) <= 1.0 + 1.5 * reach;
}

#endif
