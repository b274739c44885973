// Where light paths begin: the lights of a frame and the emissive triangles of its geometry.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

// Start of one light path. The mean of `flux` over the samples is the power of the sources.
struct Emission {
  scene::Ray ray;        // unit direction
  glm::vec3 flux{0};     // W per channel, if this were the only path
  float range = 0;       // range of the light, m, 0 if unlimited; its window applies at the first hit
  bool surface = false;  // the path starts on an emissive triangle, which is also a VPL
  glm::vec3 normal{0};   // normal of that triangle on the emitting side
};

// Chooses sources in proportion to their power (mean of the channels). A directional light sends a parallel beam
// over the silhouette of the scene's bounding box, so that nearly every ray hits the box; spot lights are
// sampled by their falloff.
class LightSampler {
 public:
  LightSampler(const scene::Frame& frame, bool emissiveTriangles, float epsilon);
  bool empty() const { return sources_.empty(); }
  bool hasSurfaces() const { return hasSurfaces_; }
  glm::dvec3 power() const { return power_; }  // of all sources, W per channel
  // Start of path `index`. Uses the first two groups of four quasi-random dimensions: the first for the source, the
  // second for the direction from a surface.
  Emission sample(uint32_t index, uint32_t seed) const;

 private:
  struct Source {
    uint32_t light = scene::kNoIndex, triangle = scene::kNoIndex;
    glm::dvec3 power{0};
    double cumulative = 0;  // sum up to and including this source, mean of the channels
  };
  void add(Source source);
  void addEmissiveTriangles();
  void sampleLight(const scene::Light& light, const float u[4], Emission& e) const;
  void sampleTriangle(const Source& source, double probability, const float u[4], uint32_t index,
                      uint32_t seed, Emission& e) const;
  glm::vec3 boxSilhouette(glm::vec3 direction) const;  // area of each pair of faces times |cosine|, m^2

  const scene::Frame& frame_;
  float epsilon_;
  std::vector<Source> sources_;
  glm::dvec3 power_{0};
  bool hasSurfaces_ = false;
};

// Power of a light in W per channel; `beamArea` is the cross-section of a directional light's beam.
glm::dvec3 lightPower(const scene::Light& light, double beamArea);
// Cosine-distributed unit direction around the unit normal.
glm::vec3 cosineDirection(glm::vec3 normal, float u, float v);
// The window of KHR_lights_punctual at distance d: 1 near the light, 0 past its range.
float rangeWindow(float distance, float range);

}  // namespace fovea::passes
