// Tests the modelling toolkit: closed solids of the expected volume, orientation, texture scale, and cages.
#include "samples/scenes/builtin/modelling/model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene::model {
namespace {

// Every directed edge between positions meets its opposite.
bool isClosed(const Shape& s) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto key = [](const glm::vec3& v) {
    // The tolerance is a hundredth of a millimetre: rings meet where the angle is 0 and 2 pi, and mitres are computed
    // in two ways.
    return Point{std::round(v.x * 1e5f), std::round(v.y * 1e5f), std::round(v.z * 1e5f)};
  };
  for (size_t i = 0; i < s.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k) {
      const Point a = key(s.positions[s.indices[i + k]]), b = key(s.positions[s.indices[i + (k + 1) % 3]]);
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  for (const auto& [edge, balance] : edges)
    if (balance != 0) return false;
  return true;
}

double volume(const Shape& s) {
  double v = 0;
  for (size_t i = 0; i < s.indices.size(); i += 3) {
    const glm::dvec3 a = s.positions[s.indices[i]], b = s.positions[s.indices[i + 1]],
                     c = s.positions[s.indices[i + 2]];
    v += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return v;
}

void expectSound(const Shape& s, const char* what) {
  ASSERT_EQ(s.normals.size(), s.positions.size()) << what;
  ASSERT_EQ(s.uvs.size(), s.positions.size()) << what;
  for (const glm::vec3& n : s.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4) << what;
  for (size_t i = 0; i < s.indices.size(); i += 3) {
    const glm::vec3 a = s.positions[s.indices[i]], b = s.positions[s.indices[i + 1]],
                    c = s.positions[s.indices[i + 2]];
    const glm::vec3 n = glm::cross(b - a, c - a);
    ASSERT_GT(glm::length(n), 0) << what;
    // Normals point to the side that the triangle faces.
    for (size_t k = 0; k < 3; ++k)
      ASSERT_GT(glm::dot(glm::normalize(n), s.normals[s.indices[i + k]]), 0.1f) << what;
  }
}

void expectSolid(const Shape& s, double expected, const char* what, double tolerance = 1e-3) {
  expectSound(s, what);
  EXPECT_TRUE(isClosed(s)) << what;
  EXPECT_NEAR(volume(s), expected, std::abs(expected) * tolerance) << what;
}

TEST(Model, BoxesAreClosedAndAsLargeAsTheySay) {
  expectSolid(box({0, 0, 0}, {1, 2, 3}), 6, "box", 1e-6);
  expectSolid(box({0, 0, 0}, {1, 2, 3}, {.cells = {2, 3, 4}}), 6, "box of cells", 1e-6);
  const Shape round = box({-1, -1, -1}, {1, 1, 1}, {.bevel = 0.25f, .bevelSteps = 4});
  // A cube whose edges are replaced by quarter rods and whose corners by parts of a ball.
  const double r = 0.25, s = 1.5,
               exact = s * s * s + 6 * s * s * r + 3 * glm::pi<double>() * r * r * s +
                       4.0 / 3 * glm::pi<double>() * r * r * r;
  expectSolid(round, exact, "rounded box", 5e-3);
  EXPECT_EQ(triangleCount(box({0, 0, 0}, {1, 1, 1})), 12u);
}

TEST(Model, SolidsOfRevolution) {
  const double pi = glm::pi<double>();
  expectSolid(sphere(1, 96, 48), 4.0 / 3 * pi, "sphere", 3e-3);
  expectSolid(cylinder(0.5f, 2, 128), pi * 0.25 * 2, "cylinder", 1e-3);
  expectSolid(torus(2, 0.5f, 128, 64), 2 * pi * pi * 2 * 0.25, "torus", 3e-3);
  const Shape fluted =
      lathe(Outline({{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
            {.segments = 64, .swell = [](float a, float) { return 1 + 0.1f * std::cos(8 * a); }});
  expectSolid(fluted, pi * (1 + 0.01 / 2), "fluted", 1e-2);
}

TEST(Model, ExtrusionsWithHoles) {
  const Outline hole = circle(0.3f, 48);
  const double cut = signedArea(hole.points());
  expectSolid(extrude(rectangle(2, 2), {hole.moved({-0.5f, 0.2f}), hole.moved({0.5f, -0.3f})}, 0.5f),
              (4 - 2 * cut) * 0.5, "plate", 1e-4);
  expectSolid(extrude(archedPanel(3, 4, 2, 2, 48), 0.4f), (12 - 4 - 0.5 * glm::pi<double>()) * 0.4, "arch",
              1e-3);
  expectSolid(extrude(rectangle(1, 1), 1, {.bevel = 0.1f}), 1 - 0.0347, "bevelled", 4e-2);
  // The direction of the outline does not matter.
  expectSolid(extrude(rectangle(2, 1).reversed(), 1), 2, "clockwise", 1e-5);
}

TEST(Model, TriangulationCoversThePolygonOnce) {
  const Outline star = [] {
    Outline o;
    for (int i = 0; i < 20; ++i) {
      const float a = glm::two_pi<float>() * float(i) / 20, r = i % 2 ? 1 : 0.4f;
      o.line(r * std::cos(a), r * std::sin(a));
    }
    return o;
  }();
  const std::vector<glm::vec2>& p = star.points();
  const std::vector<uint32_t> t = triangulate(p);
  EXPECT_EQ(t.size(), 3 * (p.size() - 2));
  double area = 0;
  for (size_t i = 0; i < t.size(); i += 3) {
    const float one = signedArea({p[t[i]], p[t[i + 1]], p[t[i + 2]]});
    EXPECT_GT(one, 0);
    area += one;
  }
  EXPECT_NEAR(area, signedArea(p), 1e-4);
}

TEST(Model, SweepsKeepTheirSectionAroundCorners) {
  // Three sides of a square frame's worth: mitred, so the volume is the section times the middle line.
  const std::vector<glm::vec3> square = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  expectSolid(sweep(square, rectangle(0.2f, 0.3f), {.closedPath = true, .up = glm::vec3(0, 1, 0)}), 0.06 * 8,
              "frame", 1e-3);
  expectSolid(sweep({{0, 0, 0}, {0, 3, 0}}, rectangle(0.2f, 0.3f)), 0.18, "bar", 1e-4);
  const Shape bent = tube(smoothPath({{0, 0, 0}, {1, 1, 0}, {2, 0, 1}, {3, 1, 1}}, 12), 0.1f, 24);
  expectSound(bent, "tube");
  EXPECT_TRUE(isClosed(bent));
  EXPECT_GT(volume(bent), 0.1);
}

TEST(Model, SheetsFaceTheReaderAndThickOnesAreClosed) {
  const Sheet flat = sheet(4, 3, {4, 3}, [](float u, float v) { return glm::vec3(4 * u, 3 - 3 * v, 0); });
  const Shape s = surface(flat);
  expectSound(s, "sheet");
  for (const glm::vec3& n : s.normals) EXPECT_NEAR(n.z, 1, 1e-5);
  expectSolid(surface(flat, 0.1f), 4 * 3 * 0.1, "thick sheet", 1e-4);
  // Texture coordinates are in metres.
  EXPECT_FLOAT_EQ(s.uvs.back().x, 4);
  EXPECT_FLOAT_EQ(s.uvs.back().y, 3);
}

TEST(Model, MirroredPlacementsKeepTheirOutside) {
  Shape s = placed(box({0, 0, 0}, {1, 2, 3}), scaled(-1, 1, 1));
  expectSolid(s, 6, "mirrored", 1e-6);
  s = placed(sphere(1, 24, 12), at(1, 2, 3) * scaled(2, 1, 0.5f));
  expectSound(s, "stretched");
}

TEST(Model, CagesOfSheetsRefineToTheSheet) {
  const auto make = [](float lift) {
    return sheet(6, 4, {6, 4}, [lift](float u, float v) { return glm::vec3(6 * u, 4 - 4 * v, lift * u); });
  };
  const SubdivisionCage c = cage(make(0), 2, {make(1)});
  EXPECT_TRUE(checkCage(c).empty());
  ASSERT_EQ(c.targets.size(), 1u);
  EXPECT_EQ(c.targets[0].positions.back(), glm::vec3(0, 0, 1));
  EXPECT_EQ(refinedTriangles(c), 6u * 4 * 32);
}

TEST(Model, PicturesRepeatWithoutASeam) {
  MasonryLook look;
  const Texture pictures[] = {
      masonry("m", look, 128, 128, 1), plaster("p", glm::vec3(0.5f), 0.3f, 0.2f, 128, 2),
      weave("w", glm::vec3(0.5f), 32, 128, 3), ground("g", glm::vec3(0.2f), glm::vec3(0.3f), 0.2f, 128, 4)};
  for (const Texture& t : pictures) {
    ASSERT_EQ(t.rgba.size(), size_t(t.width) * t.height * 4) << t.name;
    // The step across the seam is no larger than between neighbours inside.
    double seam = 0, inside = 0;
    const auto value = [&](uint32_t x, uint32_t y) { return double(t.rgba[(size_t(y) * t.width + x) * 4]); };
    for (uint32_t i = 0; i < 128; ++i) {
      seam += std::abs(value(i, 0) - value(i, 127)) + std::abs(value(0, i) - value(127, i));
      inside += std::abs(value(i, 60) - value(i, 61)) + std::abs(value(60, i) - value(61, i)) +
                std::abs(value(i, 100) - value(i, 101)) + std::abs(value(100, i) - value(101, i));
    }
    // Joints of masonry may lie on the seam.
    EXPECT_LT(seam, (t.name == "m" ? 8 : 3) * inside + 128) << t.name;
  }
}

TEST(Model, PlantsAreMadeOfSoundLeaves) {
  TreeForm form;
  form.twigs = 40;
  form.fruits = 5;
  const Plant t = tree(form);
  EXPECT_EQ(triangleCount(t.leaves), 40u * 8 * 4);
  for (const Shape* s : {&t.wood, &t.leaves, &t.fruits}) {
    for (const glm::vec3& n : s->normals) ASSERT_NEAR(glm::length(n), 1, 1e-4);
    for (const glm::vec3& p : s->positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
  EXPECT_EQ(t.leaves.positions, tree(form).leaves.positions) << "not deterministic";
}

}  // namespace
}  // namespace fovea::scene::model
