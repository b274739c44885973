#include "passes/path-trace/albedo.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "passes/path-trace/microfacets.h"

namespace fovea::path_trace {
namespace {

constexpr int kSamples = 1024;       // of an entry
constexpr int kCosines = 512;        // of a mean over directions
constexpr float kLeastRoot = 0.02f;  // square root of the cosine of the first column

// A sum of albedos with weights.
struct Sum {
  double normal = 0, grazing = 0;
  void add(Albedo a, double weight) {
    normal += weight * double(a.normal);
    grazing += weight * double(a.grazing);
  }
  Albedo value() const { return {float(normal), float(grazing)}; }
};

// Mean over the directions of sampleVisibleNormal(), each with what a mirror would reflect over its density. The random
// numbers are a Fibonacci lattice, denser towards the edge, as what is lost is lost there.
Albedo integrate(const std::function<float(float)>& curve, float cosine, float roughness) {
  const float width = ggxWidth(roughness);
  const glm::vec3 out(std::sqrt(1 - cosine * cosine), 0, cosine);
  Sum sum;
  for (int i = 0; i < kSamples; ++i) {
    const float turn = float(i) * 0.61803399f, inner = 1 - (float(i) + 0.5f) / kSamples;
    const glm::vec3 h = sampleVisibleNormal(out, width, 1 - inner * inner, turn - std::floor(turn));
    const float facing = glm::dot(out, h), rise = curve(facing);
    const glm::vec3 in = 2 * facing * h - out;
    if (!(in.z > 0)) continue;
    const float mirror = in.z * (out.z + smithTerm(out, width)) /
                         (out.z * smithTerm(in, width) + in.z * smithTerm(out, width));
    sum.add({1 - rise, rise}, double(mirror * 2 * inner) / kSamples);
  }
  return sum.value();
}

// Between two neighbours of a list, the place t within [0, 1] of its length.
struct Between {
  size_t first;
  float part;
};
Between between(float t, size_t count) {
  const float x = std::clamp(t, 0.0f, 1.0f) * float(count - 1);
  const size_t first = std::min(size_t(x), count - 2);
  return {first, x - float(first)};
}
Albedo mix(Albedo a, Albedo b, float t) {
  return {glm::mix(a.normal, b.normal, t), glm::mix(a.grazing, b.grazing, t)};
}

}  // namespace

AlbedoTable::AlbedoTable(const std::function<float(float)>& curve) {
  for (size_t row = 0; row < kSide; ++row) {
    const float roughness = float(row) / float(kSide - 1);
    for (size_t column = 0; column < kSide; ++column) {
      const float root = glm::mix(kLeastRoot, 1.0f, float(column) / float(kSide - 1));
      table_[row][column] = integrate(curve, root * root, roughness);
    }
  }
  for (size_t row = 0; row < kSide; ++row) {
    Sum sum;
    for (int i = 0; i < kCosines; ++i) {
      const float cosine = (float(i) + 0.5f) / kCosines;
      sum.add(at(cosine, float(row) / float(kSide - 1)), 2.0 * double(cosine) / kCosines);
    }
    means_[row] = sum.value();
  }
  for (int i = 0; i < kCosines; ++i) {
    const float cosine = (float(i) + 0.5f) / kCosines;
    meanCurve_ += 2 * cosine * curve(cosine) / kCosines;
  }
}

Albedo AlbedoTable::at(float cosine, float roughness) const {
  const Between row = between(roughness, kSide),
                column = between((std::sqrt(std::max(cosine, 0.0f)) - kLeastRoot) / (1 - kLeastRoot), kSide);
  const auto inRow = [&](const std::array<Albedo, kSide>& list) {
    return mix(list[column.first], list[column.first + 1], column.part);
  };
  return mix(inRow(table_[row.first]), inRow(table_[row.first + 1]), row.part);
}

Albedo AlbedoTable::mean(float roughness) const {
  const Between row = between(roughness, kSide);
  return mix(means_[row.first], means_[row.first + 1], row.part);
}

const AlbedoTable& AlbedoTable::schlick() {
  static const AlbedoTable table(schlickCurve);
  return table;
}

const AlbedoTable& AlbedoTable::dielectric(float ior) {
  static std::mutex mutex;
  static std::map<float, AlbedoTable> tables;
  const float rounded = ior > 1 ? std::clamp(std::round(ior * 50) / 50, 1.02f, 8.0f) : ior;
  const std::scoped_lock lock(mutex);
  return tables.try_emplace(rounded, [rounded](float cosine) { return fresnelCurve(cosine, rounded); })
      .first->second;
}

}  // namespace fovea::path_trace
