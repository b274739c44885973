#include "samples/scenes/builtin/modelling/plants.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fovea::scene::model {
namespace {

// The random numbers of one plant.
class Draws {
 public:
  explicit Draws(uint32_t seed) : seed_(seed) {}
  float operator()(float low = 0, float high = 1) { return random(seed_, next_++, low, high); }
  glm::vec3 direction() {
    const float y = (*this)(-1, 1), a = (*this)(0, glm::two_pi<float>()), r = std::sqrt(1 - y * y);
    return {r * std::cos(a), y, r * std::sin(a)};
  }

 private:
  uint32_t seed_, next_ = 0;
};

// Leaves around the last part of a twig, alternating, leaning forwards.
void addLeaves(Shape& to, const std::vector<glm::vec3>& twig, int count, const Shape& blade, Draws& draw) {
  for (int i = 0; i < count; ++i) {
    const float t = 0.25f + 0.75f * (float(i) + draw()) / float(count);
    const float at = t * float(twig.size() - 1);
    const size_t k = std::min(size_t(at), twig.size() - 2);
    const glm::vec3 p = glm::mix(twig[k], twig[k + 1], at - float(k));
    const glm::vec3 along = glm::normalize(twig[k + 1] - twig[k]);
    glm::vec3 out = draw.direction();
    out = glm::normalize(out - along * glm::dot(out, along) + glm::vec3(0, 0.25f, 0));
    const glm::vec3 direction = glm::normalize(along * draw(0.2f, 0.9f) + out);
    append(to, blade,
           facing(p, direction, glm::normalize(glm::vec3(0, 1, 0) + 0.5f * draw.direction())) *
               model::scaled(draw(0.75f, 1.15f)));
  }
}

}  // namespace

Shape leafBlade(const Leaf& leaf) {
  Shape s;
  const auto vertex = [&](float x, float t) {
    const float edge = std::abs(x);
    s.positions.push_back({x, leaf.fold * edge - leaf.droop * leaf.length * t * t, leaf.length * t});
    s.uvs.push_back({x, -leaf.length * t});
    return uint32_t(s.positions.size() - 1);
  };
  uint32_t left = vertex(0, 0), middle = left, right = left;
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    if (a != b && b != c && c != a) s.indices.insert(s.indices.end(), {a, b, c});
  };
  const auto half = [&](float t) {
    return 0.5f * leaf.width * std::sin(glm::pi<float>() * std::pow(t, 0.8f));
  };
  for (int i = 1; i <= leaf.steps; ++i) {
    const float t = float(i) / float(leaf.steps + 1);
    const uint32_t l = vertex(-half(t), t), m = vertex(0, t), r = vertex(half(t), t);
    triangle(left, l, m);
    triangle(left, m, middle);
    triangle(middle, m, r);
    triangle(middle, r, right);
    left = l;
    middle = m;
    right = r;
  }
  const uint32_t tip = vertex(0, 1);
  triangle(left, tip, middle);
  triangle(middle, tip, right);
  // +z runs away from the root and +y is up: seen from above the blade turns the other way round.
  s.normals.assign(s.positions.size(), glm::vec3(0, 1, 0));
  smooth(s, 80);
  return s;
}

Plant tree(const TreeForm& f) {
  Draws draw(f.seed);
  Plant plant;
  const glm::vec3 top(0.05f * f.trunkHeight * draw(-1, 1), f.trunkHeight,
                      0.05f * f.trunkHeight * draw(-1, 1));
  const glm::vec3 middle = top + glm::vec3(0, 0.9f * f.crown.y, 0);
  const std::vector<glm::vec3> trunk = smoothPath(
      {{0, -0.05f, 0}, {0.03f * draw(-1, 1), 0.4f * f.trunkHeight, 0.03f * draw(-1, 1)}, top, middle}, 5);
  append(
      plant.wood,
      tube(
          trunk, [&](float t) { return f.trunkRadius * (1 - 0.75f * t) * (1 + 0.5f * std::exp(-t * 18.0f)); },
          8));
  std::vector<std::vector<glm::vec3>> boughs;
  for (int i = 0; i < f.boughs; ++i) {
    const float a = glm::two_pi<float>() * (float(i) + 0.6f * draw()) / float(f.boughs);
    const float height = draw(-0.35f, 0.75f), r = 0.72f * std::sqrt(1 - height * height);
    const glm::vec3 end = middle + f.crown * glm::vec3(r * std::cos(a), height, r * std::sin(a));
    const glm::vec3 start = glm::mix(top, middle, draw(0.0f, 0.55f)) - glm::vec3(0, 0.05f * f.trunkHeight, 0);
    const glm::vec3 bend = glm::mix(start, end, 0.5f) + glm::vec3(0, 0.12f * f.crown.y, 0);
    boughs.push_back(smoothPath({start, bend, end}, 4));
    append(plant.wood, tube(
                           boughs.back(), [&](float t) { return f.trunkRadius * (0.45f - 0.35f * t); }, 6));
  }
  const Shape blade = leafBlade(f.leaf);
  std::vector<glm::vec3> ends;
  for (int i = 0; i < f.twigs; ++i) {
    // Evenly around the crown, mostly near its surface, and none directly below it.
    const float y = 1 - 1.75f * (float(i) + draw()) / float(f.twigs),
                r = std::sqrt(std::max(0.0f, 1 - y * y));
    const float a = float(i) * 2.39996f + draw(-0.3f, 0.3f);
    const glm::vec3 outward(r * std::cos(a), y, r * std::sin(a));
    const float depth = i % 4 == 0 ? draw(0.45f, 0.8f) : draw(0.82f, 1.0f);
    const float lump = 1 + 0.16f * (2 * fractal(glm::vec2(a * 1.3f, y * 2.5f), f.seed + 7, 2) - 1);
    const glm::vec3 end = middle + f.crown * outward * (depth * lump);
    const glm::vec3 start = end - glm::normalize(end - middle + glm::vec3(0, 0.35f, 0) * f.crown.y +
                                                 0.4f * f.crown.y * draw.direction()) *
                                      f.twigLength;
    const std::vector<glm::vec3> twig = {start, end};
    append(plant.wood,
           sweep(twig, circle(0.05f * f.trunkRadius + 0.002f, 3), {.caps = false, .creaseDegrees = 180}));
    addLeaves(plant.leaves, twig, f.leavesPerTwig, blade, draw);
    ends.push_back(end);
  }
  const Shape fruit = sphere(f.fruitRadius, 9, 6);
  for (int i = 0; i < f.fruits; ++i) {  // each below the end of a twig
    const glm::vec3& end = ends[size_t(draw(0, float(ends.size()) - 0.5f))];
    append(plant.fruits, fruit, at(end - glm::vec3(0, 1.1f * f.fruitRadius, 0)));
  }
  return plant;
}

Shape rosette(int blades, const Leaf& leaf, float spreadDegrees, uint32_t seed) {
  Draws draw(seed);
  const Shape blade = leafBlade(leaf);
  Shape s;
  for (int i = 0; i < blades; ++i) {
    const float t = float(i) / float(std::max(blades - 1, 1));
    const float lean = spreadDegrees * (0.15f + 0.85f * t) + draw(-6, 6);
    append(s, blade,
           turnY(137.5f * float(i) + draw(-12, 12)) * turnX(-90 + lean) * model::scaled(draw(0.8f, 1.05f)));
  }
  return s;
}

Plant bush(glm::vec3 dome, int stems, int leavesPerStem, const Leaf& leaf, uint32_t seed) {
  Draws draw(seed);
  Plant plant;
  const Shape blade = leafBlade(leaf);
  for (int i = 0; i < stems; ++i) {
    const float y = 1 - 0.95f * (float(i) + draw()) / float(stems), r = std::sqrt(std::max(0.0f, 1 - y * y));
    const float a = float(i) * 2.39996f + draw(-0.4f, 0.4f);
    const glm::vec3 end =
        dome * glm::vec3(r * std::cos(a), std::max(y, 0.15f), r * std::sin(a)) * draw(0.75f, 1.0f);
    const glm::vec3 root(0.25f * end.x, 0, 0.25f * end.z);
    const glm::vec3 bend = glm::mix(root, end, 0.55f) + glm::vec3(0, 0.12f * dome.y, 0);
    const std::vector<glm::vec3> stem = smoothPath({root, bend, end}, 3);
    append(plant.wood,
           sweep(stem, circle(0.008f * dome.y + 0.002f, 4), {.caps = false, .creaseDegrees = 180}));
    addLeaves(plant.leaves, stem, leavesPerStem, blade, draw);
  }
  return plant;
}

Plant trailing(int strands, float length, float spread, const Leaf& leaf, uint32_t seed) {
  Draws draw(seed);
  Plant plant;
  const Shape blade = leafBlade(leaf);
  for (int i = 0; i < strands; ++i) {
    const float x = spread * ((float(i) + draw()) / float(strands) - 0.5f), l = length * draw(0.45f, 1.0f);
    const std::vector<glm::vec3> strand =
        smoothPath({{x, 0, 0},
                    {x + draw(-0.05f, 0.05f), 0.04f, draw(0.06f, 0.12f)},
                    {x + draw(-0.08f, 0.08f), -0.45f * l, draw(0.10f, 0.18f)},
                    {x + draw(-0.12f, 0.12f), -l, draw(0.08f, 0.16f)}},
                   4);
    append(plant.wood, sweep(strand, circle(0.0035f, 3), {.caps = false, .creaseDegrees = 180}));
    addLeaves(plant.leaves, strand, int(l / length * 22) + 4, blade, draw);
  }
  return plant;
}

Plant climber(const std::vector<glm::vec3>& stem, glm::vec3 out, float reach, int twigs, int leavesPerTwig,
              const Leaf& leaf, float bloom, uint32_t seed) {
  Draws draw(seed);
  Plant plant;
  const std::vector<glm::vec3> path = smoothPath(stem, 5);
  append(plant.wood, tube(
                         path, [&](float t) { return reach * (0.055f - 0.042f * t); }, 7));
  const Shape blade = leafBlade(leaf);
  Shape bract;
  for (int i = 0; i < 3; ++i)
    append(bract, leafBlade({.length = 0.9f * leaf.length, .width = 0.75f * leaf.length, .fold = 0.5f}),
           turnY(120.0f * float(i)) * turnX(-40));
  for (int i = 0; i < twigs; ++i) {
    const float at = float(path.size() - 1) * (0.12f + 0.88f * (float(i) + draw()) / float(twigs));
    const size_t k = std::min(size_t(at), path.size() - 2);
    const glm::vec3 root = glm::mix(path[k], path[k + 1], at - float(k));
    glm::vec3 side = draw.direction();
    side -= out * std::min(0.0f, 1.6f * glm::dot(side, out));  // away from the wall
    const glm::vec3 direction = glm::normalize(side + 0.25f * out + glm::vec3(0, 0.3f, 0));
    const float length = reach * draw(0.45f, 1.0f);
    const glm::vec3 end = root + length * direction - glm::vec3(0, 0.25f * length, 0);
    const std::vector<glm::vec3> twig =
        smoothPath({root, root + 0.55f * length * direction + glm::vec3(0, 0.05f * length, 0), end}, 2);
    append(plant.wood, sweep(twig, circle(0.004f, 3), {.caps = false, .creaseDegrees = 180}));
    addLeaves(plant.leaves, twig, leavesPerTwig, blade, draw);
    if (draw() > bloom) continue;
    for (int n = 0; n < 5; ++n)
      append(plant.fruits, bract,
             facing(end + 0.22f * reach * draw.direction(), draw.direction(), glm::vec3(0.1f, 1, 0.05f)) *
                 model::scaled(draw(0.8f, 1.2f)));
  }
  return plant;
}

Plant flowers(glm::vec3 dome, int stems, float headRadius, int petals, uint32_t seed) {
  Draws draw(seed);
  Plant plant;
  const Shape petal = leafBlade({.length = 0.75f * headRadius, .width = 0.6f * headRadius, .fold = 0.4f});
  for (int i = 0; i < stems; ++i) {
    const float y = 1 - 0.7f * (float(i) + draw()) / float(stems), r = std::sqrt(std::max(0.0f, 1 - y * y));
    const float a = float(i) * 2.39996f + draw(-0.4f, 0.4f);
    const glm::vec3 end = dome * glm::vec3(r * std::cos(a), y, r * std::sin(a)) * draw(0.92f, 1.12f);
    append(plant.wood,
           sweep(smoothPath(
                     {0.2f * end * glm::vec3(1, 0, 1), 0.6f * end + glm::vec3(0, 0.1f * dome.y, 0), end}, 3),
                 circle(0.0025f, 4), {.caps = false, .creaseDegrees = 180}));
    for (int k = 0; k < petals; ++k) {
      glm::vec3 d = draw.direction();
      d.y = 0.75f * d.y + 0.2f;
      append(plant.fruits, petal,
             facing(end + 0.5f * headRadius * d, glm::normalize(d + 0.6f * draw.direction()), {0.1f, 1, 0}));
    }
  }
  return plant;
}

}  // namespace fovea::scene::model
