#include "samples/scenes/builtin/modelling/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/base/random.h"
#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {
namespace {

// sRGB encoding by a table from 12 bits to 8 bits.
uint8_t encode(float linear) {
  static const std::array<uint8_t, 4096> table = [] {
    std::array<uint8_t, 4096> t{};
    for (size_t i = 0; i < t.size(); ++i) {
      const float x = (float(i) + 0.5f) / float(t.size());
      t[i] =
          uint8_t(255.0f * (x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f) + 0.5f);
    }
    return t;
  }();
  return table[size_t(std::clamp(linear, 0.0f, 0.99999f) * 4096.0f)];
}

float wrapped(float x) { return x - std::floor(x); }

// A factor around 1: clouds and grain that repeat with the picture.
float mottle(float u, float v, float strength, uint32_t seed) {
  return 1 + strength * (2 * fractal({u * 4, v * 4}, seed, 5, 4) - 1);
}

}  // namespace

Texture bakeWithAlpha(const std::string& name, uint32_t width, uint32_t height,
                      const std::function<glm::vec4(float u, float v)>& color) {
  Texture t;
  t.name = name;
  t.width = width;
  t.height = height;
  t.rgba.resize(size_t(width) * height * 4);
  uint8_t* out = t.rgba.data();
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x, out += 4) {
      const glm::vec4 c = color((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height));
      for (int k = 0; k < 3; ++k) out[k] = encode(c[k]);
      out[3] = uint8_t(std::clamp(c.w, 0.0f, 1.0f) * 255.0f + 0.5f);
    }
  return t;
}

Texture bake(const std::string& name, uint32_t width, uint32_t height,
             const std::function<glm::vec3(float u, float v)>& color) {
  return bakeWithAlpha(name, width, height, [&](float u, float v) { return glm::vec4(color(u, v), 1); });
}

Texture masonry(const std::string& name, const MasonryLook& look, uint32_t width, uint32_t height,
                uint32_t seed) {
  const float rowsPerColumn = float(look.rows) / float(look.columns) * float(width) / float(height);
  return bake(name, width, height, [&, rowsPerColumn](float u, float v) {
    // Joints that wander a little.
    const float bend = 0.012f * (2 * noise({u * 16, v * 16}, seed + 5, 16) - 1);
    const float y = wrapped(v + bend * 0.3f) * float(look.rows);
    const int row = int(y) % look.rows;
    const float shift = look.staggered ? 0.5f * float(row & 1) + 0.12f * random(seed, uint32_t(row)) : 0.0f;
    const float x = wrapped(u + bend * 0.3f + shift / float(look.columns)) * float(look.columns);
    const int column = int(x) % look.columns;
    const float inRow = y - std::floor(y), inColumn = (x - std::floor(x)) * rowsPerColumn;
    const float edge = std::min(std::min(inRow, 1 - inRow), std::min(inColumn, rowsPerColumn - inColumn));
    const uint32_t block = uint32_t(row * look.columns + column);
    const float t = random(seed + 1, block);
    glm::vec3 c = glm::mix(look.low, look.high, t) * (1 + 0.10f * (random(seed + 2, block) - 0.5f));
    const float grain = fractal({u * 8 + 3.1f * t, v * 8}, seed + 3, 5, 8);
    c *= 1 + look.weathering * (2.2f * grain - 1.1f);
    c *= mottle(u, v, 0.5f * look.weathering, seed + 9);
    const float joint = 1 - smoothstep(0.5f * look.joint, 1.0f * look.joint, edge);
    return glm::mix(c, look.jointColor * (0.8f + 0.4f * grain), joint);
  });
}

namespace {

// Occasional narrow, elongated streaks where water has run down.
float streaks(float u, float v, uint32_t seed) {
  const float across = noise({u * 26 + 2 * noise({u * 6, v * 6}, seed + 3, 6), 0}, seed + 4, 26);
  const float place = fractal({u * 5, v * 5}, seed + 5, 2, 5);
  return across * smoothstep(0.35f, 0.75f, place);
}

}  // namespace

Texture plaster(const std::string& name, glm::vec3 color, float contrast, float stains, uint32_t size,
                uint32_t seed) {
  return bake(name, size, size, [&](float u, float v) {
    glm::vec3 c = color * mottle(u, v, contrast, seed);
    c *= 1 + 0.25f * contrast * (2 * noise({u * 96, v * 96}, seed + 1, 96) - 1);
    // Warm and cool patches.
    const float tint = contrast * 0.25f * (2 * fractal({u * 3, v * 3}, seed + 2, 3, 3) - 1);
    c *= glm::vec3(1 + tint, 1, 1 - tint);
    const float streak = streaks(u, v, seed);
    return c * (1 - stains * smoothstep(0.28f, 0.55f, streak));
  });
}

Texture boards(const std::string& name, int count, glm::vec3 low, glm::vec3 high, uint32_t size,
               uint32_t seed, float gap) {
  return bake(name, size, size, [&](float u, float v) {
    const float x = u * float(count);
    const int board = int(x) % count;
    const float in = x - std::floor(x), edge = std::min(in, 1 - in) / float(count);
    const float own = random(seed, uint32_t(board));
    // Rings, drawn out along the grain, bent by slow waves.
    const float wave = fractal({float(board) * 7.0f + u * 3, v * 2}, seed + 1, 3, 2);
    const float slow = std::sin(glm::two_pi<float>() * (v + own)) * 0.08f;
    const float rings = 0.5f + 0.5f * std::sin((in * 2.6f + slow + 0.5f * wave * in + own * 9) * 14.0f);
    const float fibre = noise({u * float(size / 4), v * 16}, seed + 2, 16);
    const float t =
        std::clamp(0.25f + 0.5f * own + 0.28f * (rings - 0.5f) + 0.22f * (fibre - 0.5f), 0.0f, 1.0f);
    return glm::mix(low, high, t) * (0.35f + 0.65f * smoothstep(0.3f * gap, gap, edge));
  });
}

Texture weave(const std::string& name, glm::vec3 color, int threads, uint32_t size, uint32_t seed) {
  return bake(name, size, size, [&](float u, float v) {
    const float pi = glm::pi<float>(), n = float(threads);
    const float a = std::sin(u * n * pi), b = std::sin(v * n * pi);
    const bool over = ((int(u * n) + int(v * n)) & 1) != 0;
    const float thread = over ? a * a : b * b;
    return color * (0.86f + 0.14f * thread) * mottle(u, v, 0.10f, seed);
  });
}

Texture stripes(const std::string& name, const std::vector<Stripe>& pattern, uint32_t size, uint32_t seed) {
  float total = 0;
  for (const Stripe& s : pattern) total += s.width;
  return bake(name, size, size, [&](float u, float v) {
    float x = wrapped(u + 0.002f * (noise({u * 8, v * 32}, seed, 8) - 0.5f)) * total;
    glm::vec3 c = pattern.back().color;
    for (const Stripe& s : pattern) {
      if (x < s.width) {
        c = s.color;
        break;
      }
      x -= s.width;
    }
    return c * mottle(u, v, 0.08f, seed + 1);
  });
}

Texture ground(const std::string& name, glm::vec3 low, glm::vec3 high, float speckle, uint32_t size,
               uint32_t seed) {
  return bake(name, size, size, [&](float u, float v) {
    const float patch = smoothstep(0.3f, 0.7f, fractal({u * 5, v * 5}, seed, 5, 5));
    const float grain = noise({u * 128, v * 128}, seed + 1, 128) + noise({u * 61, v * 61}, seed + 2, 61) - 1;
    return glm::mix(low, high, patch) * (1 + speckle * grain);
  });
}

Texture leaf(const std::string& name, glm::vec3 color, uint32_t size, uint32_t seed) {
  return bakeWithAlpha(name, size, size, [&](float u, float v) {
    const float x = std::abs(u - 0.5f), along = 1 - v;
    const float half = 0.42f * std::sin(glm::pi<float>() * std::pow(std::clamp(along, 0.0f, 1.0f), 0.75f));
    const float vein = smoothstep(0.0f, 0.02f, x);
    const float rib = 0.5f + 0.5f * std::sin((along * 1.0f + x * 0.9f) * 60.0f);
    const glm::vec3 c = color * (0.85f + 0.15f * vein) * (0.94f + 0.06f * rib) * mottle(u, v, 0.12f, seed);
    return glm::vec4(c, x < half ? 1.0f : 0.0f);
  });
}

Texture foliage(const std::string& name, glm::vec3 low, glm::vec3 high, float cover, uint32_t size,
                uint32_t seed) {
  // Leaves are ellipses, one per cell and a turned one between cells; later ones lie on top.
  constexpr int kCells = 9;
  return bakeWithAlpha(name, size, size, [&](float u, float v) {
    glm::vec4 c(glm::mix(low, high, 0.3f), 0);
    const float px = u * kCells, py = v * kCells;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        for (uint32_t layer = 0; layer < 2; ++layer) {
          const int cx = int(std::floor(px)) + dx, cy = int(std::floor(py)) + dy;
          const uint32_t cell =
              uint32_t((cx + kCells) % kCells + kCells * ((cy + kCells) % kCells)) * 2 + layer;
          if (random(seed, cell) > cover) continue;
          const float angle = glm::two_pi<float>() * random(seed + 1, cell);
          const glm::vec2 d(px - float(cx) - random(seed + 2, cell), py - float(cy) - random(seed + 3, cell));
          const glm::vec2 q(d.x * std::cos(angle) + d.y * std::sin(angle),
                            -d.x * std::sin(angle) + d.y * std::cos(angle));
          const float inside = q.x * q.x / (0.62f * 0.62f) + q.y * q.y / (0.27f * 0.27f);
          if (inside < 1)
            c = glm::vec4(glm::mix(low, high, random(seed + 4, cell)) *
                              (0.8f + 0.2f * smoothstep(0, 0.05f, std::abs(q.y))),
                          1);
        }
    return c;
  });
}

}  // namespace fovea::scene::model
