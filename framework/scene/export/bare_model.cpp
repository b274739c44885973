#include "framework/scene/export/bare_model.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/export/files.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

using Json = nlohmann::ordered_json;

Json listOf(const glm::vec3& v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }
Json listOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// The degrees with the fewest digits that are read as this angle again.
double degreesOf(float radians) {
  const double exact = glm::degrees(double(radians));
  for (int digits = 3; digits < 17; ++digits)
    if (const double d = std::stod(fmt::format("{:.{}g}", exact, digits)); float(glm::radians(d)) == radians)
      return d;
  return exact;
}

Json firstCameraJson(const Scene& s) {
  const Camera& c = s.cameras.at(0);
  const glm::vec3 forward = c.orientation * glm::vec3(0, 0, -1), up = c.orientation * glm::vec3(0, 1, 0);
  Json camera = {{"eye", listOf(authoredPlace(s, c.position))},
                 {"target", listOf(authoredPlace(s, c.position) + glm::dvec3(forward))}};
  // How the orientation follows from `target` alone.
  const glm::vec3 upright = lookAlong(forward, {0, 1, 0}) * glm::vec3(0, 1, 0);
  if (glm::distance(up, upright) > 1e-5f) camera["up"] = listOf(up);
  camera["fov_deg"] = degreesOf(c.verticalFov);
  if (c.aspectRatio > 0) camera["aspect"] = shortest(c.aspectRatio);
  camera["near"] = shortest(c.zNear);
  if (c.zFar > 0) camera["far"] = shortest(c.zFar);
  return camera;
}

// Whether the first camera moves with its node, which no camera of a scene file does.
bool cameraIsCarried(const Scene& s) {
  const NodePoses poses(s);
  for (uint32_t i = 0; i < s.nodes.size(); ++i)
    if (s.nodes[i].camera == 0) return poses.animated(i);
  return false;
}

// A scene file that shows the same as a model on its own (samples/scenes/README.md).
Json sceneFileOf(const Scene& s, const std::string& environment) {
  Json file = Json::object();
  file["models"] = {{{"file", s.source}}};
  if (!cameraIsCarried(s)) file["camera"] = firstCameraJson(s);
  if (s.assumedFloor) {
    const Node& floor = s.nodes.back();
    const uint32_t material = s.meshes[floor.mesh].primitives[0].material;
    file["floor"] = {{"position", listOf(authoredPlace(s, floor.translation))},
                     {"radius", shortest(floor.scale.x)},
                     {"color", listOf(glm::vec3(s.materials[material].baseColor))}};
  }
  if (s.assumedLamp) {
    const Light& lamp = s.lights.back();
    file["lights"] = {{{"type", "point"},
                       {"name", lamp.name},
                       {"intensity", shortest(lamp.intensity)},
                       {"color", listOf(lamp.color)},
                       {"position", listOf(authoredPlace(s, lamp.position))}}};
  }
  if (s.fullMaterials) file["materials"] = "full";
  file["exposure"] = shortest(s.exposure);
  if (s.assumedSky)
    file["environment"]["sky"] = {{"sun_elevation_deg", degreesOf(s.assumedSky->sunElevation)},
                                  {"sun_azimuth_deg", degreesOf(s.assumedSky->sunAzimuth)},
                                  {"ground", listOf(s.assumedSky->ground)}};
  else if (s.environmentMap)
    file["environment"] = {{"file", environment}};
  else
    file["environment"] = listOf(s.environment);
  return file;
}

}  // namespace

std::string bareModelFile(const Scene& scene, const std::string& environment) {
  std::string text = "{";
  const char* before = "\n";
  const Json file = sceneFileOf(scene, environment);
  for (const auto& [key, value] : file.items()) {
    text += before + ("  \"" + key) + "\": " + value.dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  return text + "\n}\n";
}

}  // namespace fovea::scene
