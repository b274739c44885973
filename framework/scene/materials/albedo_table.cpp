#include "framework/scene/materials/albedo_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "framework/scene/materials/microfacets.h"

namespace fovea::scene {
namespace {

constexpr int kSamples = 1024;       // of an entry
constexpr int kSteps = 512;          // of an integral over the cosine
constexpr float kLeastRoot = 0.02f;  // square root of the cosine of the first column, which is not 0

Albedo mix(Albedo a, Albedo b, float t) {
  return {a.low + t * (b.low - a.low), a.high + t * (b.high - a.high)};
}

// Mean over visible normals; each is worth F * G2 / G1 (Heitz 2018, Eq. 19).
Albedo integrate(const std::function<float(float)>& curve, float cosine, float roughness) {
  const float alpha = ggxAlpha(roughness);
  const glm::vec3 out(std::sqrt(std::max(1 - cosine * cosine, 0.0f)), 0, cosine);
  const float lambda = smithLambda(out, alpha);
  double low = 0, high = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float turn =
        float(i) * 0.61803399f;  // a Fibonacci lattice: rings near the edge hold what little is lost
    const glm::vec3 h =
        sampleVisibleNormal(out, alpha, (float(i) + 0.5f) / kSamples, turn - std::floor(turn));
    const float facing = glm::dot(out, h);
    const glm::vec3 in = 2 * facing * h - out;
    if (in.z <= 0) continue;
    const double visible = double((1 + lambda) / (1 + lambda + smithLambda(in, alpha))),
                 c = double(curve(facing));
    low += visible * (1 - c);
    high += visible * c;
  }
  return {float(low / kSamples), float(high / kSamples)};
}

struct Place {
  size_t first;
  float fraction;
};
Place placeOf(float t, size_t count) {
  const float x = std::clamp(t, 0.0f, 1.0f) * float(count - 1);
  const size_t first = std::min(size_t(x), count - 2);
  return {first, x - float(first)};
}

}  // namespace

AlbedoTable::AlbedoTable(const std::function<float(float)>& curve) {
  for (size_t row = 0; row < kSide; ++row)
    for (size_t column = 0; column < kSide; ++column) {
      const float root = kLeastRoot + (1 - kLeastRoot) * float(column) / float(kSide - 1);
      entries_[row * kSide + column] = integrate(curve, root * root, float(row) / float(kSide - 1));
    }
  for (size_t row = 0; row < kSide; ++row) {
    double low = 0, high = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float cosine = (float(i) + 0.5f) / kSteps;
      const Albedo a = at(cosine, float(row) / float(kSide - 1));
      low += 2.0 * double(cosine * a.low) / kSteps;
      high += 2.0 * double(cosine * a.high) / kSteps;
    }
    averages_[row] = {float(low), float(high)};
  }
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float cosine = (float(i) + 0.5f) / kSteps;
    sum += 2.0 * double(cosine * curve(cosine)) / kSteps;
  }
  averageCurve_ = float(sum);
}

Albedo AlbedoTable::at(float cosine, float roughness) const {
  const Place row = placeOf(roughness, kSide),
              column = placeOf((std::sqrt(std::max(cosine, 0.0f)) - kLeastRoot) / (1 - kLeastRoot), kSide);
  const Albedo* entry = &entries_[row.first * kSide + column.first];
  return mix(mix(entry[0], entry[1], column.fraction), mix(entry[kSide], entry[kSide + 1], column.fraction),
             row.fraction);
}

Albedo AlbedoTable::average(float roughness) const {
  const Place row = placeOf(roughness, kSide);
  return mix(averages_[row.first], averages_[row.first + 1], row.fraction);
}

const AlbedoTable& AlbedoTable::schlick() {
  static const AlbedoTable table(schlickCurve);
  return table;
}

// There are at most 449 tables, so that a file with thousands of indices costs seconds.
const AlbedoTable& AlbedoTable::dielectric(float ior) {
  constexpr float kCentre = 1.5f, kPerOctave = 32, kLimit = 7 * kPerOctave;
  static std::mutex mutex;
  static std::map<float, AlbedoTable> tables;
  float nearest = ior;
  if (ior > 1)
    nearest =
        kCentre * std::exp2(std::clamp(std::round(std::log2(ior / kCentre) * kPerOctave), -kLimit, kLimit) /
                            kPerOctave);
  if (ior > 1) nearest = std::max(nearest, 1.001f);
  const std::scoped_lock lock(mutex);
  return tables.try_emplace(nearest, [nearest](float cosine) { return dielectricCurve(cosine, nearest); })
      .first->second;
}

}  // namespace fovea::scene
