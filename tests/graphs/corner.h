// A small scene with every kind of light, and functions that render it with a stock graph and compare the pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/scene/environment/environment_map.h"
#include "places.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {

constexpr uint32_t kSide = 40;  // of the pictures, pixels

// The stock graphs that are tested in every run; the others are tested only among the long tests.
inline const std::vector<std::string> kGraphs{"direct",
                                              "ir_1000",
                                              "ours",
                                              "foveal",
                                              "foveal_stereo",
                                              "reference",
                                              "alternatives/ddgi",
                                              "alternatives/vxgi",
                                              "alternatives/restir_gi"};
inline std::vector<std::string> otherGraphs() {
  std::vector<std::string> names;
  for (const std::string folder : {"", "alternatives/"})
    for (const auto& entry : std::filesystem::directory_iterator(FOVEA_SOURCE_DIR "/graphs/" + folder)) {
      const std::string name = folder + entry.path().stem().string();
      if (entry.path().extension() == ".json" && name != "fovea-graph.schema" &&
          std::ranges::find(kGraphs, name) == kGraphs.end())
        names.push_back(name);
    }
  std::ranges::sort(names);
  return names;
}

inline std::string nameOfGraph(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '/', '_');
  return name;
}

// A floor and a wall under a sky, lit by a sun, a point light, a spot light and an emissive panel.
inline scene::Scene cornerInTheOpen() {
  scene::Scene s;
  s.fullMaterials = true;
  addQuad(s, addMaterial(s, {0.6f, 0.5f, 0.4f}), {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addQuad(s, addMaterial(s, {0.3f, 0.6f, 0.3f}), {-4, 0, -1}, {8, 0, 0}, {0, 3, 0});
  const uint32_t panel = addMaterial(s, glm::vec3(0.2f));
  s.materials[panel].emission = {2, 1.5f, 1};
  addQuad(s, panel, {-1.5f, 0.4f, -0.99f}, {0.8f, 0, 0}, {0, 0.8f, 0});
  std::vector<glm::vec3> texels(16 * 8, glm::vec3(0.3f, 0.4f, 0.6f));
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(16, 8, texels);
  s.lights.resize(3);
  s.lights[0].direction = glm::normalize(glm::vec3(0.4f, -1, -0.5f));
  s.lights[0].intensity = 2;
  s.lights[1].type = scene::LightType::Point;
  s.lights[1].position = {1.5f, 1, 0.5f};
  s.lights[2].type = scene::LightType::Spot;
  s.lights[2].position = {-1, 2, 1};
  s.lights[2].direction = {0, -1, 0};
  s.lights[2].intensity = 3;
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 1.5f, 4};
  s.cameras[0].orientation = glm::angleAxis(glm::radians(-12.0f), glm::vec3(1, 0, 0));
  s.exposure = 0.4f;
  return s;
}

inline GraphRun renderCorner(const std::string& name, const scene::Scene& s) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = 3;
  options.set = {"vpl_count=100", "map_size=32", "shadow_map_size=128", "voxels=32", "spp=8"};
  std::erase_if(options.set, [&](const std::string& set) {
    const bool traced = name == "reference" || name == "alternatives/reference_stereo",
               vpls = name != "direct" && !traced && !name.starts_with("alternatives/");
    if (set.starts_with("spp")) return !traced;
    if (set.starts_with("shadow")) return traced;
    if (set.starts_with("voxels")) return name.starts_with("ir_") || (!vpls && name != "alternatives/vxgi");
    return !vpls;
  });
  options.outputs = {"radiance"};
  return runGraph(name, s, options);
}

// Mean over the colours of all pixels of the squared difference, relative to the squared expected value plus 0.01.
inline double relativeError(const std::vector<float>& values, const std::vector<float>& expected) {
  double error = 0;
  for (size_t i = 0; i < expected.size(); ++i)
    if (i % 4 != 3)
      error += std::pow(double(values[i] - expected[i]), 2) / (std::pow(double(expected[i]), 2) + 0.01);
  return error / (0.75 * double(expected.size()));
}

}  // namespace fovea::test
