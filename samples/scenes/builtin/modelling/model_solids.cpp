// Boxes, lathes, sweeps and extrusions of the modelling toolkit.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {
namespace {

// A point of a profile or section with the normal of one of its sides; two at the same place form an edge.
struct Row {
  glm::vec2 position, normal;
  float length;  // along the outline
};

std::vector<Row> rowsOf(const std::vector<glm::vec2>& given, bool closed, float creaseDegrees) {
  std::vector<glm::vec2> p;
  for (const glm::vec2& q : given)
    if (p.empty() || glm::length(q - p.back()) > 1e-6f) p.push_back(q);
  if (closed && p.size() > 1 && glm::length(p.front() - p.back()) < 1e-6f) p.pop_back();
  const size_t n = p.size(), last = closed ? n : n - 1;
  const float crease = std::cos(glm::radians(creaseDegrees));
  const auto normalOf = [&](size_t segment) {  // from point `segment` to the next
    const glm::vec2 d = p[(segment + 1) % n] - p[segment % n];
    return glm::normalize(glm::vec2(d.y, -d.x));
  };
  std::vector<Row> rows;
  float length = 0;
  for (size_t i = 0; i <= last; ++i) {
    const bool hasBefore = closed || i > 0, hasAfter = closed || i < last;
    const glm::vec2 before = normalOf(hasBefore ? (i + n - 1) % n : i);
    const glm::vec2 after = normalOf(hasAfter ? i % n : i - 1);
    if (glm::dot(before, after) < crease) {
      // The first row of a closed outline has only the side after it, the last only the one before.
      if (!(closed && i == 0)) rows.push_back({p[i % n], before, length});
      if (!(closed && i == last)) rows.push_back({p[i % n], after, length});
    } else {
      rows.push_back({p[i % n], glm::normalize(before + after), length});
    }
    if (i < last) length += glm::length(p[(i + 1) % n] - p[i % n]);
  }
  return rows;
}

void addTriangle(Shape& s, uint32_t a, uint32_t b, uint32_t c) {
  if (s.positions[a] == s.positions[b] || s.positions[b] == s.positions[c] ||
      s.positions[c] == s.positions[a])
    return;
  s.indices.insert(s.indices.end(), {a, b, c});
}

void addVertex(Shape& s, glm::vec3 position, glm::vec3 normal, glm::vec2 uv) {
  s.positions.push_back(position);
  s.normals.push_back(normal);
  s.uvs.push_back(uv);
}

// Coordinates of a box's face along one axis: where the rounded edge bends from, and the tangent of its angle there.
struct BoxLine {
  float inner, tangent;
};

std::vector<BoxLine> boxLines(float low, float high, float bevel, int steps, int cells) {
  std::vector<BoxLine> lines;
  const auto tangent = [&](int i) {  // exactly 1 at an edge of the box, where two faces meet
    return i == 0 ? 1.0f : std::tan(0.25f * glm::pi<float>() * (1 - float(i) / float(steps)));
  };
  if (bevel > 0)
    for (int i = 0; i < steps; ++i) lines.push_back({low + bevel, -tangent(i)});
  for (int i = 0; i <= cells; ++i)
    lines.push_back({low + bevel + (high - low - 2 * bevel) * float(i) / float(cells), 0});
  if (bevel > 0)
    for (int i = steps - 1; i >= 0; --i) lines.push_back({high - bevel, tangent(i)});
  return lines;
}

struct Frame {
  glm::vec3 tangent, side, up;
};

// One frame per segment of the path.
std::vector<Frame> framesOf(const std::vector<glm::vec3>& path, size_t segments,
                            const std::optional<glm::vec3>& up) {
  std::vector<Frame> frames(segments);
  for (size_t i = 0; i < segments; ++i) {
    Frame& f = frames[i];
    f.tangent = glm::normalize(path[(i + 1) % path.size()] - path[i]);
    if (up || i == 0) {
      glm::vec3 y = up.value_or(std::abs(f.tangent.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1));
      if (std::abs(glm::dot(f.tangent, y)) > 0.9999f) y = glm::vec3(0, 0, 1);
      f.side = glm::normalize(glm::cross(f.tangent, y));
    } else {  // turned as little as the path allows
      f.side = glm::normalize(glm::quat(frames[i - 1].tangent, f.tangent) * frames[i - 1].side);
    }
    f.up = glm::cross(f.side, f.tangent);
  }
  return frames;
}

// Rows of vertices around the path's points.
struct SweepRing {
  uint32_t point, segment;  // the segment whose frame gives its normals
  bool averaged;            // with the segment before
};

std::vector<SweepRing> ringsOf(const std::vector<Frame>& frames, size_t points, bool closed,
                               float creaseDegrees) {
  const float crease = std::cos(glm::radians(creaseDegrees));
  const uint32_t segments = uint32_t(frames.size());
  std::vector<SweepRing> rings;
  for (uint32_t i = 0; i <= segments; ++i) {
    const bool inner = closed || (i > 0 && i < segments);
    const uint32_t before = (i + segments - 1) % segments, after = i % segments;
    const uint32_t point = uint32_t(i % points);
    if (!inner) {
      rings.push_back({point, i == 0 ? 0 : segments - 1, false});
    } else if (glm::dot(frames[before].tangent, frames[after].tangent) < crease) {
      if (i > 0) rings.push_back({point, before, false});
      if (i < segments) rings.push_back({point, after, false});
    } else {
      rings.push_back({point, after, true});
    }
  }
  return rings;
}

}  // namespace

Shape box(glm::vec3 low, glm::vec3 high, const BoxOptions& options) {
  const glm::vec3 extent = high - low;
  const float bevel = std::min(options.bevel, 0.49f * std::min({extent.x, extent.y, extent.z}));
  struct Face {
    int a, b, n;  // axes
    float signA, signB, signN;
  };
  const Face faces[6] = {{0, 1, 2, 1, 1, 1},  {0, 1, 2, -1, 1, -1}, {2, 1, 0, -1, 1, 1},
                         {2, 1, 0, 1, 1, -1}, {0, 2, 1, 1, -1, 1},  {0, 2, 1, 1, 1, -1}};
  Shape s;
  for (const Face& f : faces) {
    if (f.n == 1 && f.signN < 0 && !options.bottom) continue;
    const auto linesOf = [&](int axis, float sign) {
      std::vector<BoxLine> lines =
          boxLines(low[axis], high[axis], bevel, options.bevelSteps, options.cells[axis]);
      if (sign < 0) std::reverse(lines.begin(), lines.end());
      return lines;
    };
    const std::vector<BoxLine> across = linesOf(f.a, f.signA), along = linesOf(f.b, f.signB);
    const uint32_t base = uint32_t(s.positions.size()), width = uint32_t(across.size());
    for (const BoxLine& v : along)
      for (const BoxLine& u : across) {
        glm::vec3 inner, direction;
        inner[f.a] = u.inner;
        inner[f.b] = v.inner;
        inner[f.n] = f.signN > 0 ? high[f.n] - bevel : low[f.n] + bevel;
        direction[f.a] = u.tangent;
        direction[f.b] = v.tangent;
        direction[f.n] = f.signN;
        direction = glm::normalize(direction);
        const glm::vec3 p = inner + bevel * direction;
        addVertex(s, p, direction, {f.signA * p[f.a], -f.signB * p[f.b]});
      }
    for (uint32_t j = 0; j + 1 < along.size(); ++j)
      for (uint32_t i = 0; i + 1 < width; ++i) {
        const uint32_t a = base + j * width + i, b = a + 1, c = b + width, d = a + width;
        addTriangle(s, a, b, c);
        addTriangle(s, a, c, d);
      }
  }
  return s;
}

Shape block(float width, float height, float depth, const BoxOptions& options) {
  return box({-0.5f * width, 0, -0.5f * depth}, {0.5f * width, height, 0.5f * depth}, options);
}

Shape lathe(const Outline& profile, const LatheOptions& o) {
  const std::vector<Row> rows = rowsOf(profile.points(), o.closed, o.creaseDegrees);
  const bool full = o.toDegrees - o.fromDegrees >= 359.99f;
  float widest = 0;
  for (const Row& r : rows) widest = std::max(widest, r.position.x);
  Shape s;
  for (int i = 0; i <= o.segments; ++i) {
    const float part = float(full ? i % o.segments : i) / float(o.segments);
    const float angle = glm::radians(o.fromDegrees + (o.toDegrees - o.fromDegrees) * part);
    const float u = widest * glm::radians(o.toDegrees - o.fromDegrees) * float(i) / float(o.segments);
    const float c = std::cos(angle), sn = std::sin(angle);
    for (const Row& r : rows) {
      const float x = std::max(r.position.x, 0.0f) * (o.swell ? o.swell(angle, r.position.y) : 1.0f);
      addVertex(s, {x * c, r.position.y, -x * sn}, {r.normal.x * c, r.normal.y, -r.normal.x * sn},
                {u, -r.length});
    }
  }
  const uint32_t height = uint32_t(rows.size());
  for (uint32_t i = 0; i < uint32_t(o.segments); ++i)
    for (uint32_t r = 0; r + 1 < height; ++r) {
      if (rows[r].position == rows[r + 1].position) continue;
      const uint32_t a = i * height + r, b = a + height, c = b + 1, d = a + 1;
      addTriangle(s, a, b, c);
      addTriangle(s, a, c, d);
    }
  if (o.swell) smooth(s, o.creaseDegrees);
  return s;
}

Shape sphere(float radius, int segments, int rings) {
  Outline half({0, -radius});
  half.arc(0, radius, 1, rings);
  std::vector<glm::vec2> points = half.points();
  points.back().x = 0;
  Shape s;
  Outline exact;
  for (const glm::vec2& p : points) exact.line(p.x < 1e-6f * radius ? 0 : p.x, p.y);
  s = lathe(exact, {.segments = segments, .creaseDegrees = 180});
  for (size_t i = 0; i < s.positions.size(); ++i) s.normals[i] = glm::normalize(s.positions[i]);
  return s;
}

Shape cylinder(float radius, float height, int segments, float bevel) {
  Outline o({0, 0});
  if (bevel > 0)
    o.line(radius - bevel, 0)
        .arc(radius, bevel, 0.41421356f, 3)
        .line(radius, height - bevel)
        .arc(radius - bevel, height, 0.41421356f, 3);
  else
    o.line(radius, 0).line(radius, height);
  return lathe(o.line(0, height), {.segments = segments});
}

Shape torus(float majorRadius, float minorRadius, int segments, int sides) {
  return lathe(circle(minorRadius, sides).moved({majorRadius, 0}),
               {.segments = segments, .creaseDegrees = 180, .closed = true});
}

Shape sweep(const std::vector<glm::vec3>& given, const Outline& section, const SweepOptions& o) {
  std::vector<glm::vec3> path;
  for (const glm::vec3& p : given)
    if (path.empty() || glm::length(p - path.back()) > 1e-6f) path.push_back(p);
  if (o.closedPath && glm::length(path.front() - path.back()) < 1e-6f) path.pop_back();
  std::vector<glm::vec2> outline = section.points();
  if (o.closedSection && signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
  const std::vector<Row> rows = rowsOf(outline, o.closedSection, o.creaseDegrees);
  const size_t segments = o.closedPath ? path.size() : path.size() - 1;
  const std::vector<Frame> frames = framesOf(path, segments, o.up);
  const std::vector<SweepRing> rings = ringsOf(frames, path.size(), o.closedPath, o.creaseDegrees);

  std::vector<float> lengths(segments + 1, 0.0f);
  for (size_t i = 0; i < segments; ++i)
    lengths[i + 1] = lengths[i] + glm::length(path[(i + 1) % path.size()] - path[i]);
  Shape s;
  const auto place = [&](const SweepRing& ring, size_t at, glm::vec2 p) {
    const Frame& f = frames[ring.segment];
    const float t = lengths[at] / lengths.back(), twist = glm::radians(o.twistDegrees) * t;
    const float c = std::cos(twist), sn = std::sin(twist), scale = o.scale ? o.scale(t) : 1.0f;
    p = scale * glm::vec2(c * p.x - sn * p.y, sn * p.x + c * p.y);
    return f.side * p.x + f.up * p.y;
  };
  for (size_t k = 0, at = 0; k < rings.size(); ++k) {
    const SweepRing& ring = rings[k];
    if (k > 0 && ring.point != rings[k - 1].point) ++at;
    const Frame& f = frames[ring.segment];
    const bool inner = o.closedPath || (at > 0 && at < segments);
    const Frame& before = frames[(at + segments - 1) % segments];
    const Frame& after = frames[at % segments];
    const glm::vec3 bisector = inner ? glm::normalize(before.tangent + after.tangent) : f.tangent;
    for (const Row& r : rows) {
      // Along the segment onto the plane between it and its neighbour: a mitre.
      glm::vec3 offset = place(ring, at, r.position);
      offset -= f.tangent * (glm::dot(offset, bisector) / std::max(glm::dot(f.tangent, bisector), 0.2f));
      glm::vec3 n = place(ring, at, r.normal);
      if (ring.averaged)
        n += place({ring.point, uint32_t((at + segments - 1) % segments), false}, at, r.normal);
      addVertex(s, path[ring.point] + offset, glm::length(n) > 1e-9f ? glm::normalize(n) : f.up,
                {lengths[at], r.length});
    }
  }
  const uint32_t width = uint32_t(rows.size());
  for (uint32_t k = 0; k + 1 < rings.size(); ++k) {
    if (rings[k].point == rings[k + 1].point) continue;
    for (uint32_t r = 0; r + 1 < width; ++r) {
      if (rows[r].position == rows[r + 1].position) continue;
      const uint32_t a = k * width + r, b = a + width, c = b + 1, d = a + 1;
      addTriangle(s, a, b, c);
      addTriangle(s, a, c, d);
    }
  }
  if (o.closedPath || !o.closedSection || !o.caps) return s;
  const std::vector<uint32_t> cap = triangulate(outline);
  for (const bool end : {false, true}) {
    const SweepRing& ring = end ? rings.back() : rings.front();
    const glm::vec3 normal = end ? frames.back().tangent : -frames.front().tangent;
    const uint32_t base = uint32_t(s.positions.size());
    for (const glm::vec2& p : outline)
      addVertex(s, path[ring.point] + place(ring, end ? segments : 0, p), normal, {p.x, -p.y});
    for (size_t i = 0; i < cap.size(); i += 3)
      addTriangle(s, base + cap[i], base + cap[end ? i + 2 : i + 1], base + cap[end ? i + 1 : i + 2]);
  }
  return s;
}

Shape tube(const std::vector<glm::vec3>& path, float radius, int sides, bool closed) {
  return sweep(path, circle(radius, sides), {.closedPath = closed, .creaseDegrees = 75});
}

Shape tube(const std::vector<glm::vec3>& path, const std::function<float(float)>& radius, int sides) {
  return sweep(path, circle(1, sides), {.creaseDegrees = 75, .scale = radius});
}

std::vector<glm::vec3> smoothPath(const std::vector<glm::vec3>& p, int stepsEach, bool closed) {
  const int n = int(p.size());
  const auto point = [&](int i) {
    return closed ? p[size_t((i + n) % n)] : p[size_t(std::clamp(i, 0, n - 1))];
  };
  std::vector<glm::vec3> path;
  for (int i = 0; i < (closed ? n : n - 1); ++i)
    for (int k = 0; k < stepsEach; ++k) {
      const float t = float(k) / float(stepsEach);
      const glm::vec3 a = point(i - 1), b = point(i), c = point(i + 1), d = point(i + 2);
      path.push_back(0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                             (3.0f * (b - c) + d - a) * t * t * t));
    }
  if (!closed) path.push_back(p.back());
  return path;
}

Shape extrude(const Outline& outline, float depth, const ExtrudeOptions& options) {
  return extrude(outline, {}, depth, options);
}

namespace {

// The outline drawn in by `distance`, towards the solid on its left.
std::vector<glm::vec2> inset(const std::vector<glm::vec2>& p, float distance) {
  std::vector<glm::vec2> result;
  const size_t n = p.size();
  const auto normalOf = [&](size_t i) {
    const glm::vec2 d = p[(i + 1) % n] - p[i % n];
    return glm::normalize(glm::vec2(d.y, -d.x));
  };
  for (size_t i = 0; i < n; ++i) {
    const glm::vec2 a = normalOf(i + n - 1), b = normalOf(i);
    result.push_back(p[i] - distance * (a + b) / std::max(1 + glm::dot(a, b), 0.2f));
  }
  return result;
}

// The side wall of a closed outline between two heights; `from` and `to` have equally many points.
void addWall(Shape& s, const std::vector<glm::vec2>& from, const std::vector<glm::vec2>& to, float z0,
             float z1, float creaseDegrees, float tilt) {
  const std::vector<Row> low = rowsOf(from, true, creaseDegrees);
  const bool straight = from == to;
  const size_t n = from.size();
  const auto nearest = [&](glm::vec2 p) {  // the same corner of `to`
    if (straight) return p;
    for (size_t i = 0; i < n; ++i)
      if (glm::length(from[i] - p) < 1e-6f) return to[i];
    return p;
  };
  const uint32_t base = uint32_t(s.positions.size());
  for (const Row& r : low) {
    const glm::vec3 normal = glm::normalize(glm::vec3(r.normal, tilt));
    addVertex(s, glm::vec3(r.position, z0), normal, {r.length, -z0});
    addVertex(s, glm::vec3(nearest(r.position), z1), normal, {r.length, -z1});
  }
  for (uint32_t i = 0; i + 1 < low.size(); ++i) {
    if (low[i].position == low[i + 1].position) continue;
    const uint32_t a = base + 2 * i, b = a + 2, c = a + 3, d = a + 1;
    addTriangle(s, a, b, c);
    addTriangle(s, a, c, d);
  }
}

}  // namespace

Shape extrude(const Outline& outline, const std::vector<Outline>& holes, float depth,
              const ExtrudeOptions& o) {
  std::vector<std::vector<glm::vec2>> loops{outline.points()};
  for (const Outline& h : holes) loops.push_back(h.points());
  for (size_t i = 0; i < loops.size(); ++i) {
    std::vector<glm::vec2> clean;
    for (const glm::vec2& p : loops[i])
      if (clean.empty() || glm::length(p - clean.back()) > 1e-6f) clean.push_back(p);
    if (glm::length(clean.front() - clean.back()) < 1e-6f) clean.pop_back();
    if ((signedArea(clean) > 0) != (i == 0)) std::reverse(clean.begin(), clean.end());
    loops[i] = std::move(clean);
  }
  Shape s;
  std::vector<std::vector<glm::vec2>> faces = loops;
  const float backBevel = o.back ? o.bevel : 0;
  for (size_t i = 0; i < loops.size(); ++i) {
    addWall(s, loops[i], loops[i], backBevel, depth - o.bevel, o.creaseDegrees, 0);
    if (o.bevel <= 0) continue;
    faces[i] = inset(loops[i], o.bevel);
    addWall(s, loops[i], faces[i], depth - o.bevel, depth, o.creaseDegrees, 1);
    if (o.back) {
      Shape chamfer;
      addWall(chamfer, loops[i], faces[i], o.bevel, 0, o.creaseDegrees, -1);
      for (size_t k = 0; k < chamfer.indices.size(); k += 3)
        std::swap(chamfer.indices[k + 1], chamfer.indices[k + 2]);
      append(s, chamfer);
    }
  }
  const std::vector<uint32_t> triangles =
      triangulate(faces[0], std::vector<std::vector<glm::vec2>>(faces.begin() + 1, faces.end()));
  for (const bool front : {false, true}) {
    if (!front && !o.back) continue;
    const uint32_t base = uint32_t(s.positions.size());
    for (const auto& loop : faces)
      for (const glm::vec2& p : loop)
        addVertex(s, {p, front ? depth : 0}, {0, 0, front ? 1 : -1}, {front ? p.x : -p.x, -p.y});
    for (size_t i = 0; i < triangles.size(); i += 3)
      addTriangle(s, base + triangles[i], base + triangles[front ? i + 1 : i + 2],
                  base + triangles[front ? i + 2 : i + 1]);
  }
  return s;
}

}  // namespace fovea::scene::model
