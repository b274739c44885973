// Control cages for the tests.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene::test {

inline void addFace(SubdivisionCage& cage, std::initializer_list<uint32_t> vertices) {
  cage.faceSizes.push_back(uint32_t(vertices.size()));
  cage.faceVertices.insert(cage.faceVertices.end(), vertices);
}

// Corners at +-1; vertex i has x in bit 0, y in bit 1, z in bit 2. Face 5 is the top, z = 1.
inline SubdivisionCage cubeCage(uint32_t level) {
  SubdivisionCage cage;
  cage.level = level;
  for (int i = 0; i < 8; ++i) cage.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  addFace(cage, {0, 4, 6, 2});
  addFace(cage, {1, 3, 7, 5});
  addFace(cage, {0, 1, 5, 4});
  addFace(cage, {2, 6, 7, 3});
  addFace(cage, {0, 2, 3, 1});
  addFace(cage, {4, 5, 7, 6});
  return cage;
}

// (nx - 1) x (ny - 1) quads over points (x, y, height), counter-clockwise seen from +z; its uvs are (x, y).
template <class Height>
SubdivisionCage gridCage(uint32_t nx, uint32_t ny, uint32_t level, const Height& height) {
  SubdivisionCage cage;
  cage.level = level;
  for (uint32_t y = 0; y < ny; ++y)
    for (uint32_t x = 0; x < nx; ++x) cage.positions.emplace_back(x, y, height(x, y));
  for (const glm::vec3& p : cage.positions) cage.uvs.emplace_back(p);
  for (uint32_t y = 0; y + 1 < ny; ++y)
    for (uint32_t x = 0; x + 1 < nx; ++x) {
      const uint32_t a = y * nx + x;
      addFace(cage, {a, a + 1, a + 1 + nx, a + nx});
    }
  cage.faceUvs = cage.faceVertices;
  return cage;
}

// n x m quads on a torus.
inline SubdivisionCage torusCage(uint32_t n, uint32_t m, uint32_t level) {
  SubdivisionCage cage;
  cage.level = level;
  const float turn = 2 * std::numbers::pi_v<float>;
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t k = 0; k < m; ++k) {
      const float a = turn * float(i) / float(n), b = turn * float(k) / float(m);
      const float r = 2 + 0.7f * std::cos(b);
      cage.positions.emplace_back(r * std::cos(a), r * std::sin(a), 0.7f * std::sin(b));
    }
  const auto at = [&](uint32_t i, uint32_t k) { return i % n * m + k % m; };
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t k = 0; k < m; ++k) addFace(cage, {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
  return cage;
}

inline SubdivisionCage tetrahedronCage(uint32_t level) {
  SubdivisionCage cage;
  cage.scheme = SubdivisionCage::Scheme::Loop;
  cage.level = level;
  cage.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  addFace(cage, {0, 1, 2});
  addFace(cage, {0, 2, 3});
  addFace(cage, {0, 3, 1});
  addFace(cage, {1, 3, 2});
  return cage;
}

inline SubdivisionCage icosahedronCage(uint32_t level) {
  SubdivisionCage cage;
  cage.scheme = SubdivisionCage::Scheme::Loop;
  cage.level = level;
  const float g = std::numbers::phi_v<float>;
  cage.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr std::array<std::array<uint32_t, 3>, 20> kFaces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (const auto& f : kFaces) addFace(cage, {f[0], f[1], f[2]});
  return cage;
}

// A fan of `count` faces over `angle` around vertex 0 in the plane z = 0; the faces are quads, or triangles for Loop.
inline SubdivisionCage fanCage(SubdivisionCage::Scheme scheme, uint32_t count, float angle, uint32_t level) {
  SubdivisionCage cage;
  cage.scheme = scheme;
  cage.level = level;
  cage.positions.emplace_back(0, 0, 0);
  const bool quads = scheme == SubdivisionCage::Scheme::CatmullClark;
  const uint32_t steps = quads ? 2 * count : count;
  for (uint32_t i = 0; i <= steps; ++i) {
    const float a = angle * float(i) / float(steps), r = quads && i % 2 ? 1.5f : 1.0f;
    cage.positions.emplace_back(r * std::cos(a), r * std::sin(a), 0);
  }
  for (uint32_t i = 0; i < count; ++i) {
    if (quads)
      addFace(cage, {0, 2 * i + 1, 2 * i + 2, 2 * i + 3});
    else
      addFace(cage, {0, i + 1, i + 2});
  }
  return cage;
}

// The cage with its points displaced by up to `size`.
inline SubdivisionCage jittered(SubdivisionCage cage, float size, uint32_t seed) {
  for (size_t i = 0; i < cage.positions.size(); ++i)
    for (int k = 0; k < 3; ++k)
      cage.positions[i][k] += size * (2 * uniformFloat(hashCombine(seed, uint32_t(3 * i) + uint32_t(k))) - 1);
  return cage;
}

// Creases, a corner, seams and two materials on a closed surface: everything that the tables must represent.
inline SubdivisionCage everythingCage(uint32_t level) {
  SubdivisionCage cage = jittered(torusCage(6, 5, level), 0.1f, 7);
  const auto at = [](uint32_t i, uint32_t k) { return i % 6 * 5 + k % 5; };
  for (uint32_t i = 0; i < 6; ++i) cage.creases.push_back({at(i, 0), at(i + 1, 0), 10});
  for (uint32_t k = 0; k < 3; ++k) cage.creases.push_back({at(2, k), at(2, k + 1), k == 2 ? 1.5f : 10.0f});
  cage.corners.push_back({at(4, 1), 10});
  for (uint32_t f = 0; f < cage.faceSizes.size(); ++f) {
    cage.faceMaterials.push_back(f % 3 == 0 ? 1 : 0);
    const glm::vec2 low(float(f / 5), float(f % 5));
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      cage.faceUvs.push_back(uint32_t(cage.uvs.size()));
      cage.uvs.push_back(low + corner);
    }
  }
  return cage;
}

}  // namespace fovea::scene::test
