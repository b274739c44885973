#include "framework/scene/tables/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace fovea::scene {
namespace {

// The axes of TriangleTangents: two edges, and a normal that scales with them.
glm::dmat3 axesOf(glm::dvec3 edgeB, glm::dvec3 edgeC) {
  const glm::dvec3 n = glm::cross(edgeB, edgeC);
  const double area = glm::length(n);
  return {edgeB, edgeC, area > 0 ? n / std::sqrt(area) : glm::dvec3(0)};
}

glm::dvec3 unitOrZero(glm::dvec3 v) {
  const double length = glm::length(v);
  return length > 1e-20 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

glm::dvec3 inPlane(glm::dvec3 v, glm::dvec3 normal) { return unitOrZero(v - normal * glm::dot(v, normal)); }

class TangentMaker {
 public:
  TangentMaker(const Primitive& p, const std::vector<glm::vec2>& uvs) : p_(p), uvs_(uvs) {}

  std::vector<TriangleTangents> fromTextureCoordinates() {
    const size_t count = p_.indices.size() / 3;
    std::vector<glm::dvec3> sums;
    std::vector<size_t> sumOf(3 * count);
    std::vector<float> signs(count);
    std::map<Key, size_t> known;
    for (size_t t = 0; t < count; ++t) {
      glm::dvec3 direction(0);
      signs[t] = orientation(t, direction);
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = p_.indices[3 * t + k];
        const auto [place, isNew] = known.try_emplace(keyOf(v, signs[t]), sums.size());
        if (isNew) sums.emplace_back(0);
        sumOf[3 * t + k] = place->second;
        const glm::dvec3 normal(p_.normals[v]);
        sums[place->second] += inPlane(direction, normal) * angle(t, k, normal);
      }
    }
    std::vector<TriangleTangents> list(count);
    for (size_t t = 0; t < count; ++t)
      list[t] = relative(t, {sums[sumOf[3 * t]], sums[sumOf[3 * t + 1]], sums[sumOf[3 * t + 2]]}, signs[t]);
    return list;
  }

  std::vector<TriangleTangents> fromModel() {
    std::vector<TriangleTangents> list(p_.indices.size() / 3);
    for (size_t t = 0; t < list.size(); ++t) {
      const uint32_t* v = &p_.indices[3 * t];
      list[t] = relative(
          t, {glm::vec3(p_.tangents[v[0]]), glm::vec3(p_.tangents[v[1]]), glm::vec3(p_.tangents[v[2]])},
          p_.tangents[v[0]].w < 0 ? -1.0f : 1.0f);
    }
    return list;
  }

 private:
  // Position, normal, texture coordinates and orientation, bit by bit.
  using Key = std::array<uint32_t, 9>;
  Key keyOf(uint32_t v, float sign) const {
    const glm::vec3 &p = p_.positions[v], &n = p_.normals[v];
    const auto bits = [](float f) { return std::bit_cast<uint32_t>(f == 0 ? 0.0f : f); };  // -0 is 0
    return {bits(p.x), bits(p.y),       bits(p.z),       bits(n.x), bits(n.y),
            bits(n.z), bits(uvs_[v].x), bits(uvs_[v].y), bits(sign)};
  }

  glm::dvec3 edge(size_t t, size_t from, size_t to) const {
    return glm::dvec3(p_.positions[p_.indices[3 * t + to]]) -
           glm::dvec3(p_.positions[p_.indices[3 * t + from]]);
  }

  // Sets the unit direction in which u grows. Returns the sign of the bitangent, which points to where v falls: in
  // glTF v runs down, and the second component of a normal map points up.
  float orientation(size_t t, glm::dvec3& direction) const {
    const glm::dvec2 a(uvs_[p_.indices[3 * t]]), b = glm::dvec2(uvs_[p_.indices[3 * t + 1]]) - a,
                                                 c = glm::dvec2(uvs_[p_.indices[3 * t + 2]]) - a;
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0) return 1;
    const double sign = area < 0 ? -1 : 1;
    direction = unitOrZero(sign * (c.y * edge(t, 0, 1) - b.y * edge(t, 0, 2)));
    return float(-sign);
  }

  // Between the two edges at corner k as they appear along the normal.
  double angle(size_t t, size_t k, glm::dvec3 normal) const {
    const glm::dvec3 a = inPlane(edge(t, k, (k + 1) % 3), normal),
                     b = inPlane(edge(t, k, (k + 2) % 3), normal);
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
  }

  TriangleTangents relative(size_t t, const std::array<glm::dvec3, 3>& tangents, float sign) const {
    TriangleTangents result;
    const glm::dmat3 axes = axesOf(edge(t, 0, 1), edge(t, 0, 2));
    if (!(std::abs(glm::determinant(axes)) > 0)) return result;
    const glm::dmat3 inverse = glm::inverse(axes);
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3 c(inverse * unitOrZero(tangents[k]));
      if (std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)) result.corners[k] = c;
    }
    result.bitangentSign = sign;
    return result;
  }

  const Primitive& p_;
  const std::vector<glm::vec2>& uvs_;
};

}  // namespace

std::vector<TriangleTangents> triangleTangents(const Primitive& primitive, uint32_t set) {
  const bool second = set == 1 && !primitive.secondUvs.empty();
  TangentMaker maker(primitive, second ? primitive.secondUvs : primitive.uvs);
  return primitive.tangents.empty() ? maker.fromTextureCoordinates() : maker.fromModel();
}

TriangleTangents turned(const TriangleTangents& tangents) {
  const auto exchanged = [](glm::vec3 c) { return glm::vec3(c.y, c.x, c.z); };
  return {{exchanged(tangents.corners[0]), exchanged(tangents.corners[2]), exchanged(tangents.corners[1])},
          -tangents.bitangentSign};
}

glm::vec3 tangentAt(const TriangleTangents& tangents, glm::vec3 edgeB, glm::vec3 edgeC, float u, float v) {
  const glm::vec3 n = glm::cross(edgeB, edgeC);
  const float area = glm::length(n);
  const auto corner = [&](int k) {
    const glm::vec3& c = tangents.corners[k];
    const glm::vec3 t = c.x * edgeB + c.y * edgeC + (area > 0 ? c.z / std::sqrt(area) : 0.0f) * n;
    const float length = glm::length(t);
    return length > 0 ? t / length : t;
  };
  return (1 - u - v) * corner(0) + u * corner(1) + v * corner(2);
}

}  // namespace fovea::scene
