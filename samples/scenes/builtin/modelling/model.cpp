// Noise, placements and outlines of the modelling toolkit.
#include "samples/scenes/builtin/modelling/model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "framework/base/random.h"

namespace fovea::scene::model {
namespace {

// Value of the noise at a corner of its grid.
float latticeValue(int x, int y, uint32_t seed, int period) {
  if (period > 0) {
    x = ((x % period) + period) % period;
    y = ((y % period) + period) % period;
  }
  return uniformFloat(hashPcg(uint32_t(x) * 0x9e3779b9u ^ hashPcg(uint32_t(y) ^ seed)));
}

float lerp(float a, float b, float t) { return a + (b - a) * t; }

glm::vec2 catmullRom(glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d, float t) {
  return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                 (3.0f * (b - c) + d - a) * t * t * t);
}

// Twice the area of a triangle, positive counter-clockwise.
float turn(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct RingPoint {
  glm::vec2 p;
  uint32_t index;
};

// Joins a hole (clockwise) to the ring around it by a bridge from the hole's rightmost point to the nearest point of
// the ring that is visible from there.
void bridge(std::vector<RingPoint>& ring, const std::vector<RingPoint>& hole) {
  size_t start = 0;
  for (size_t i = 1; i < hole.size(); ++i)
    if (hole[i].p.x > hole[start].p.x) start = i;
  const glm::vec2 from = hole[start].p;
  const auto crosses = [&](glm::vec2 to, glm::vec2 a, glm::vec2 b) {
    if (a == to || b == to || a == from || b == from) return false;
    return turn(from, to, a) * turn(from, to, b) < 0 && turn(a, b, from) * turn(a, b, to) < 0;
  };
  size_t best = ring.size();
  float bestDistance = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const glm::vec2 to = ring[i].p, next = ring[(i + 1) % ring.size()].p,
                    last = ring[(i + ring.size() - 1) % ring.size()].p;
    const float distance = glm::length(to - from);
    if (best < ring.size() && distance >= bestDistance) continue;
    // Inside the angle of the ring at `to`.
    const bool convex = turn(last, to, next) > 0;
    const bool left = turn(to, next, from) > 0, right = turn(last, to, from) > 0;
    if (convex ? !(left && right) : !(left || right)) continue;
    bool blocked = false;
    for (size_t j = 0; j < ring.size() && !blocked; ++j)
      blocked = crosses(to, ring[j].p, ring[(j + 1) % ring.size()].p);
    for (size_t j = 0; j < hole.size() && !blocked; ++j)
      blocked = crosses(to, hole[j].p, hole[(j + 1) % hole.size()].p);
    if (blocked) continue;
    best = i;
    bestDistance = distance;
  }
  if (best == ring.size()) return;  // not inside: nothing to cut out
  std::vector<RingPoint> insert;
  for (size_t k = 0; k <= hole.size(); ++k) insert.push_back(hole[(start + k) % hole.size()]);
  insert.push_back(ring[best]);
  ring.insert(ring.begin() + ptrdiff_t(best) + 1, insert.begin(), insert.end());
}

bool isEar(const std::vector<RingPoint>& ring, size_t i) {
  const size_t n = ring.size();
  const glm::vec2 a = ring[(i + n - 1) % n].p, b = ring[i].p, c = ring[(i + 1) % n].p;
  if (turn(a, b, c) <= 1e-12f) return false;
  for (const RingPoint& q : ring) {
    if (q.p == a || q.p == b || q.p == c) continue;
    if (turn(a, b, q.p) >= 0 && turn(b, c, q.p) >= 0 && turn(c, a, q.p) >= 0) return false;
  }
  return true;
}

// Sine of the smallest angle of a triangle, so that ears that are not slivers are cut first.
float quality(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  const float ab = glm::length(b - a), bc = glm::length(c - b), ca = glm::length(a - c);
  return turn(a, b, c) / std::max({ab * bc, bc * ca, ca * ab, 1e-12f});
}

}  // namespace

float random(uint32_t seed, uint32_t index) { return uniformFloat(hashCombine(hashPcg(seed), index)); }

float random(uint32_t seed, uint32_t index, float low, float high) {
  return lerp(low, high, random(seed, index));
}

float noise(glm::vec2 p, uint32_t seed, int period) {
  const float fx = std::floor(p.x), fy = std::floor(p.y);
  const int x = int(fx), y = int(fy);
  float tx = p.x - fx, ty = p.y - fy;
  tx = tx * tx * (3 - 2 * tx);
  ty = ty * ty * (3 - 2 * ty);
  const float low = lerp(latticeValue(x, y, seed, period), latticeValue(x + 1, y, seed, period), tx);
  const float high = lerp(latticeValue(x, y + 1, seed, period), latticeValue(x + 1, y + 1, seed, period), tx);
  return lerp(low, high, ty);
}

float fractal(glm::vec2 p, uint32_t seed, int octaves, int period) {
  float sum = 0, weight = 0.5f, total = 0;
  for (int o = 0; o < octaves; ++o) {
    sum += weight * noise(p, seed + uint32_t(o) * 7919u, period);
    total += weight;
    weight *= 0.5f;
    p *= 2.0f;
    period *= 2;
  }
  return sum / total;
}

glm::mat4 at(float x, float y, float z) { return at(glm::vec3(x, y, z)); }
glm::mat4 at(glm::vec3 p) { return glm::translate(glm::mat4(1), p); }
glm::mat4 turnX(float degrees) { return glm::rotate(glm::mat4(1), glm::radians(degrees), {1, 0, 0}); }
glm::mat4 turnY(float degrees) { return glm::rotate(glm::mat4(1), glm::radians(degrees), {0, 1, 0}); }
glm::mat4 turnZ(float degrees) { return glm::rotate(glm::mat4(1), glm::radians(degrees), {0, 0, 1}); }
glm::mat4 scaled(float s) { return scaled(s, s, s); }
glm::mat4 scaled(float x, float y, float z) { return glm::scale(glm::mat4(1), {x, y, z}); }

glm::mat4 facing(glm::vec3 p, glm::vec3 direction, glm::vec3 up) {
  const glm::vec3 z = glm::normalize(direction);
  glm::vec3 x = glm::cross(up, z);
  if (glm::dot(x, x) < 1e-6f)
    x = glm::cross(std::abs(z.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1), z);
  x = glm::normalize(x);
  glm::mat4 m(1);
  m[0] = glm::vec4(x, 0);
  m[1] = glm::vec4(glm::cross(z, x), 0);
  m[2] = glm::vec4(z, 0);
  m[3] = glm::vec4(p, 1);
  return m;
}

Outline& Outline::line(float x, float y) {
  points_.push_back({x, y});
  return *this;
}

Outline& Outline::by(float dx, float dy) { return line(points_.back().x + dx, points_.back().y + dy); }

Outline& Outline::arc(float x, float y, float bulge, int steps) {
  const glm::vec2 a = points_.back(), b(x, y), chord = b - a;
  if (std::abs(bulge) < 1e-5f || chord == glm::vec2(0)) return line(x, y);
  const float angle = 4 * std::atan(bulge);
  const glm::vec2 right = glm::vec2(chord.y, -chord.x) / glm::length(chord);
  const float length = glm::length(chord), radius = length * (1 + bulge * bulge) / (4 * bulge);
  const glm::vec2 centre = 0.5f * (a + b) + right * (0.5f * bulge * length - radius);
  for (int i = 1; i < steps; ++i) {
    const float t = angle * float(i) / float(steps), c = std::cos(t), s = std::sin(t);
    const glm::vec2 d = a - centre;
    points_.push_back(centre + glm::vec2(c * d.x - s * d.y, s * d.x + c * d.y));
  }
  return line(x, y);
}

Outline& Outline::curve(glm::vec2 c1, glm::vec2 c2, glm::vec2 end, int steps) {
  const glm::vec2 a = points_.back();
  for (int i = 1; i <= steps; ++i) {
    const float t = float(i) / float(steps), s = 1 - t;
    points_.push_back(s * s * s * a + 3 * s * s * t * c1 + 3 * s * t * t * c2 + t * t * t * end);
  }
  return *this;
}

Outline& Outline::through(const std::vector<glm::vec2>& points, int stepsEach) {
  std::vector<glm::vec2> all{points_.back()};
  all.insert(all.end(), points.begin(), points.end());
  for (size_t i = 0; i + 1 < all.size(); ++i) {
    const glm::vec2 before = all[i == 0 ? 0 : i - 1], after = all[std::min(i + 2, all.size() - 1)];
    for (int k = 1; k <= stepsEach; ++k)
      points_.push_back(catmullRom(before, all[i], all[i + 1], after, float(k) / float(stepsEach)));
  }
  return *this;
}

Outline& Outline::append(const Outline& other) {
  for (const glm::vec2& p : other.points_)
    if (points_.empty() || points_.back() != p) points_.push_back(p);
  return *this;
}

Outline Outline::moved(glm::vec2 by) const {
  Outline o = *this;
  for (glm::vec2& p : o.points_) p += by;
  return o;
}

Outline Outline::scaled(glm::vec2 by) const {
  Outline o = *this;
  for (glm::vec2& p : o.points_) p *= by;
  return o;
}

Outline Outline::reversed() const {
  Outline o = *this;
  std::reverse(o.points_.begin(), o.points_.end());
  return o;
}

Outline circle(float radius, int sides) {
  Outline o;
  for (int i = 0; i < sides; ++i) {
    const float a = glm::two_pi<float>() * float(i) / float(sides);
    o.line(radius * std::cos(a), radius * std::sin(a));
  }
  return o;
}

Outline rectangle(float width, float height) {
  const float x = 0.5f * width, y = 0.5f * height;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

Outline roundedRectangle(float width, float height, float radius, int steps) {
  const float x = 0.5f * width, y = 0.5f * height, r = std::min({radius, x, y}), q = 0.41421356f;
  Outline o({-x + r, -y});
  o.line(x - r, -y).arc(x, -y + r, q, steps).line(x, y - r).arc(x - r, y, q, steps);
  o.line(-x + r, y).arc(-x, y - r, q, steps).line(-x, -y + r).arc(-x + r, -y, q, steps);
  std::vector<glm::vec2> p = o.points();
  p.pop_back();
  Outline clean;
  for (const glm::vec2& q2 : p)
    if (clean.points().empty() || glm::length(clean.points().back() - q2) > 1e-6f) clean.line(q2.x, q2.y);
  return clean;
}

Outline archedOpening(float opening, float sill, float spring, int steps, std::optional<float> rise) {
  const float half = 0.5f * opening, bulge = rise ? *rise / half : 1.0f;
  Outline o({-half, sill});
  o.line(half, sill).line(half, spring).arc(-half, spring, bulge, steps);
  return o;
}

Outline archedPanel(float width, float height, float opening, float spring, int steps,
                    std::optional<float> rise) {
  const float half = 0.5f * opening, bulge = rise ? *rise / half : 1.0f;
  Outline o({half, 0});
  o.line(0.5f * width, 0).line(0.5f * width, height).line(-0.5f * width, height).line(-0.5f * width, 0);
  o.line(-half, 0).line(-half, spring).arc(half, spring, -bulge, steps);
  return o;
}

float signedArea(const std::vector<glm::vec2>& polygon) {
  float area = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    area += 0.5f * (a.x * b.y - a.y * b.x);
  }
  return area;
}

std::vector<uint32_t> triangulate(const std::vector<glm::vec2>& outer,
                                  const std::vector<std::vector<glm::vec2>>& holes) {
  uint32_t next = 0;
  const auto ringOf = [&](const std::vector<glm::vec2>& points, bool counterClockwise) {
    std::vector<RingPoint> ring;
    for (const glm::vec2& p : points) ring.push_back({p, next++});
    if ((signedArea(points) > 0) != counterClockwise) std::reverse(ring.begin(), ring.end());
    return ring;
  };
  std::vector<RingPoint> ring = ringOf(outer, true);
  std::vector<std::vector<RingPoint>> inner;
  for (const auto& h : holes) inner.push_back(ringOf(h, false));
  const auto rightmost = [](const std::vector<RingPoint>& r) {
    float x = r.front().p.x;
    for (const RingPoint& q : r) x = std::max(x, q.p.x);
    return x;
  };
  std::stable_sort(inner.begin(), inner.end(),
                   [&](const auto& a, const auto& b) { return rightmost(a) > rightmost(b); });
  for (const auto& h : inner) bridge(ring, h);

  std::vector<uint32_t> triangles;
  while (ring.size() >= 3) {
    const size_t n = ring.size();
    size_t best = n;
    float bestQuality = 0;
    for (size_t i = 0; i < n; ++i) {
      const float q = quality(ring[(i + n - 1) % n].p, ring[i].p, ring[(i + 1) % n].p);
      if (q > bestQuality && isEar(ring, i)) {
        best = i;
        bestQuality = q;
      }
    }
    if (best == n) break;  // what is left has no area
    for (size_t k : {(best + n - 1) % n, best, (best + 1) % n}) triangles.push_back(ring[k].index);
    ring.erase(ring.begin() + ptrdiff_t(best));
  }
  return triangles;
}

}  // namespace fovea::scene::model
