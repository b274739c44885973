#include "passes/path-trace/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fovea::path_trace {
namespace {

constexpr float kPi = glm::pi<float>();
constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace

Distribution::Distribution(const std::vector<float>& weights) : shares_(weights.size() + 1) {
  for (const float w : weights) sum_ += double(w);
  if (!(sum_ > 0)) return;
  double before = 0;
  for (size_t i = 0; i < weights.size(); ++i) shares_[i + 1] = float((before += double(weights[i])) / sum_);
  shares_.back() = 1;
}

Distribution::Choice Distribution::choose(float u) const {
  // The first share above u belongs to what follows the choice, so that nothing of weight 0 is chosen.
  const auto after = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, u);
  const auto index = uint32_t(after - shares_.begin() - 1);
  return {index, std::min((u - shares_[index]) / probability(index), kBelowOne)};
}

// A texel counts with the mean of the interpolated light over it: 3/4 of its own and 1/8 of each neighbour's, in both
// directions.
Environment::Environment(const scene::EnvironmentMap& map) : map_(map), rows_({}) {
  const int width = int(map.width()), height = int(map.height());
  const auto light = [&](int x, int y) {
    const glm::vec3& t = texel(x, y);
    return t.r + t.g + t.b;
  };
  std::vector<float> rows(map.height()), row(map.width()), means(map.width());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      row[size_t(x)] = 0.75f * light(x, y) + 0.125f * (light(x, y - 1) + light(x, y + 1));
    for (int x = 0; x < width; ++x)
      means[size_t(x)] = 0.75f * row[size_t(x)] +
                         0.125f * (row[size_t((x + width - 1) % width)] + row[size_t((x + 1) % width)]);
    columns_.emplace_back(means);
    rows[size_t(y)] = float(columns_.back().sum() * double(solidAngle(uint32_t(y))));
  }
  rows_ = Distribution(rows);
}

// Around from one edge to the other, and not beyond the poles.
const glm::vec3& Environment::texel(int x, int y) const {
  const int width = int(map_.width()), height = int(map_.height());
  return map_.texels()[size_t(std::clamp(y, 0, height - 1)) * size_t(width) + size_t((x + width) % width)];
}

// The width of a texel times the height of the zone of its row, cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2).
float Environment::solidAngle(uint32_t row) const {
  const float step = kPi / float(map_.height());
  return 2 * kPi / float(map_.width()) * 2 * std::sin((float(row) + 0.5f) * step) * std::sin(0.5f * step);
}

glm::vec2 Environment::texelsFromCorner(glm::vec3 direction) const {
  const float around = std::atan2(direction.x, -direction.z) + map_.turn(),
              down = std::acos(glm::clamp(direction.y, -1.0f, 1.0f));
  return {glm::fract(around / (2 * kPi) + 0.5f) * float(map_.width()), down / kPi * float(map_.height())};
}

glm::vec3 Environment::radiance(glm::vec3 direction) const {
  const glm::vec2 p = texelsFromCorner(direction) - 0.5f, corner = glm::floor(p), part = p - corner;
  const int x = int(corner.x), y = int(corner.y);
  const auto inRow = [&](int row) { return glm::mix(texel(x, row), texel(x + 1, row), part.x); };
  return glm::mix(inRow(y), inRow(y + 1), part.y);
}

float Environment::density(glm::vec3 direction) const {
  const glm::uvec2 size(map_.width(), map_.height()),
      p = glm::min(glm::uvec2(texelsFromCorner(direction)), size - 1u);
  return densityIn(p.x, p.y);
}

// Even over the solid angle of a texel.
Environment::Sample Environment::sample(float u, float v) const {
  Sample s;
  if (!(rows_.sum() > 0)) return s;
  const Distribution::Choice row = rows_.choose(v), column = columns_[row.index].choose(u);
  const auto zenith = [&](uint32_t edge) { return std::cos(float(edge) / float(map_.height()) * kPi); };
  const float y = glm::mix(zenith(row.index), zenith(row.index + 1), row.within),
              across = std::sqrt(std::max(1 - y * y, 0.0f)),
              around = ((float(column.index) + column.within) / float(map_.width()) - 0.5f) * 2 * kPi -
                       map_.turn();
  s.direction = {across * std::sin(around), y, -across * std::cos(around)};
  s.radiance = radiance(s.direction);
  s.density = densityIn(column.index, row.index);
  return s;
}

}  // namespace fovea::path_trace
