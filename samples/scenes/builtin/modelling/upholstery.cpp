#include "samples/scenes/builtin/modelling/upholstery.h"

#include <algorithm>
#include <cmath>

namespace fovea::scene::model {
namespace {

float bump(float x, float width) { return std::exp(-x * x / (width * width)); }

// Distance from x to the nearest multiple of 2.
float fromEven(float x) { return std::abs(x - 2 * std::round(0.5f * x)); }

// A block with round edges whose top sinks by sink(x, z), a share of its height; nothing sinks near the edges.
Shape padded(glm::vec3 size, glm::ivec3 cells, const std::function<float(float, float)>& sink) {
  const float bevel = 0.3f * size.y;
  return bent(
      block(size.x, size.y, size.z, {.bevel = bevel, .bevelSteps = 3, .cells = cells}),
      [&](glm::vec3 q) {
        const float edge = std::min(0.5f * size.x - std::abs(q.x), 0.5f * size.z - std::abs(q.z));
        const float inside =
            smoothstep(0.4f * bevel, 2.0f * bevel, edge) * smoothstep(0.5f, 0.95f, q.y / size.y);
        q.y += size.y * inside * (0.12f - sink(q.x, q.z));
        return q;
      },
      70);
}

}  // namespace

Shape cushion(float width, float height, float thickness, uint32_t seed, uint32_t level) {
  // A net of 7 x 7 points for the front and one for the back; they share their rim.
  constexpr int n = 6;
  SubdivisionCage c;
  c.level = level;
  int front[n + 1][n + 1], back[n + 1][n + 1];
  for (int side = 0; side < 2; ++side)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const bool rim = i == 0 || j == 0 || i == n || j == n;
        if (side == 1 && rim) {
          back[j][i] = front[j][i];
          continue;
        }
        const float x = 2 * float(i) / n - 1, y = 2 * float(j) / n - 1;
        // The edges are drawn in between the corners, the middle is full and uneven.
        const float pull = 1 - 0.09f * (1 - y * y) * x * x - 0.0f, pullY = 1 - 0.09f * (1 - x * x) * y * y;
        const float fill = std::pow((1 - x * x) * (1 - y * y), 0.45f);
        const float lump = 1 + 0.22f * (2 * random(seed, uint32_t(side * 64 + j * 8 + i)) - 1);
        const float z = rim ? 0.012f * (2 * random(seed + 1, uint32_t(j * 8 + i)) - 1)
                            : 0.62f * thickness * fill * lump * (side == 0 ? 1.0f : -1.0f);
        (side == 0 ? front : back)[j][i] = int(c.positions.size());
        c.positions.push_back({0.5f * width * x * pull, 0.5f * height * y * pullY, z});
        c.uvs.push_back({0.5f * width * x, -0.5f * height * y});
      }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      c.faceSizes.insert(c.faceSizes.end(), {4u, 4u});
      for (const int v : {front[j][i], front[j][i + 1], front[j + 1][i + 1], front[j + 1][i]})
        c.faceVertices.push_back(uint32_t(v));
      for (const int v : {back[j][i], back[j + 1][i], back[j + 1][i + 1], back[j][i + 1]})
        c.faceVertices.push_back(uint32_t(v));
    }
  c.faceUvs = c.faceVertices;
  c.corners = {{uint32_t(front[0][0]), 10},
               {uint32_t(front[0][n]), 10},
               {uint32_t(front[n][0]), 10},
               {uint32_t(front[n][n]), 10}};
  Shape s = refine(c).front();
  s.material = 0;
  smooth(s, 70);  // the seam is an edge at the corners
  return s;
}

Shape roundCushion(float radius, float height, int segments) {
  const float r = radius, h = height;
  Outline o({0, -0.22f * h});
  o.line(0.06f * r, -0.26f * h)
      .curve({0.35f * r, -0.62f * h}, {0.93f * r, -0.55f * h}, {0.97f * r, -0.06f * h}, 9);
  o.arc(0.97f * r, 0.06f * h, 0.9f, 4);
  o.curve({0.93f * r, 0.55f * h}, {0.35f * r, 0.62f * h}, {0.06f * r, 0.26f * h}, 9).line(0, 0.22f * h);
  return lathe(o, {.segments = segments, .creaseDegrees = 60, .swell = [](float a, float) {
                     return 1 + 0.012f * std::cos(12 * a);
                   }});
}

Shape buttonedPad(glm::vec3 size, int columns, int rows) {
  return padded(size, {10 * columns, 1, 10 * rows}, [=](float x, float z) {
    const float u = (x / size.x + 0.5f) * float(columns), v = (z / size.z + 0.5f) * float(rows);
    const float a = fromEven(2 * u + v), b = fromEven(2 * u - v);
    return 0.16f * std::max(bump(a, 0.16f), bump(b, 0.16f)) + 0.22f * bump(a, 0.35f) * bump(b, 0.35f);
  });
}

Shape channelPad(glm::vec3 size, int channels) {
  return padded(size, {10 * channels, 1, 6}, [=](float x, float) {
    const float u = (x / size.x + 0.5f) * float(channels);
    return 0.30f * bump(0.5f * fromEven(2 * u), 0.14f);
  });
}

}  // namespace fovea::scene::model
