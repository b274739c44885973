// The command `fovea scene info`: what a scene contains once loaded. `scene export` is in scene_export.cpp.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "fovea/scene.h"
#include "framework/graph/report/report.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/export/bare_model.h"
#include "framework/scene/load.h"
#include "framework/scene/motion/animation.h"
#include "framework/scene/origin.h"
#include "framework/scene/scene.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

using scene::Scene;

void line(const char* what, const std::string& value) { fmt::print("{:<10}  {}\n", what, value); }

std::string formatVector(const glm::vec3& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }

// In the author's coordinates, with all digits of those that are too large for single precision.
std::string formatPlace(const Scene& s, const glm::vec3& v) {
  const glm::dvec3 p = scene::toAuthor(s, v);
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format("{}{:.{}g}", axis > 0 ? " " : "", p[axis], s.origin[axis] != 0 ? 12 : 4);
  return text;
}

std::string formatLight(const Scene& s, const scene::Light& light) {
  const glm::vec3 strength = light.color * light.intensity;
  switch (light.type) {
    case scene::LightType::Directional:
      return fmt::format("directional, {} lux, towards {}", formatVector(strength),
                         formatVector(light.direction));
    case scene::LightType::Point:
      return fmt::format("point, {} cd, at {}", formatVector(strength), formatPlace(s, light.position));
    case scene::LightType::Spot:
      return fmt::format("spot, {} cd, at {}, towards {}, cone {:.3g} degrees", formatVector(strength),
                         formatPlace(s, light.position), formatVector(light.direction),
                         2 * glm::degrees(light.outerConeAngle));
  }
  return {};
}

template <class Motion>
std::string formatPath(const std::string& name, const Motion& m) {
  const char* after = m.repeat == scene::Repeat::Loop       ? ", again and again"
                      : m.repeat == scene::Repeat::PingPong ? ", back and forth"
                                                            : "";
  return fmt::format("{}, {} keys over {:.3g} s{}", name, m.keys.size(), m.keys.back().time, after);
}

void printContents(const Scene& s, const scene::Geometry& geometry) {
  size_t textureBytes = 0, masked = 0, emissive = 0;
  for (const scene::Texture& t : s.textures) textureBytes += t.rgba.size();
  for (const scene::Material& m : s.materials) {
    masked += m.masked;
    emissive += glm::any(glm::greaterThan(m.emission, glm::vec3(0)));
  }
  size_t dynamic = 0;
  for (const scene::Object& o : geometry.objects) dynamic += o.dynamic;
  line("triangles", fmt::format("{} ({} of them moving)", geometry.triangles.size(),
                                geometry.triangles.size() - geometry.staticTriangles));
  if (const scene::Geometry::LightTriangles light = geometry.light(); light.first > 0)
    line("", fmt::format("{} for voxels and VPL maps ({} of them moving)", light.end - light.first,
                         light.end - light.firstMoving));
  line("vertices", fmt::format("{}", geometry.positions.size()));
  line("objects", fmt::format("{} ({} of them moving)", geometry.objects.size(), dynamic));
  line("materials", fmt::format("{} ({} masked, {} emissive)", s.materials.size(), masked, emissive));
  line("textures", fmt::format("{} ({})", s.textures.size(), graph::printBytes(textureBytes)));
  if (geometry.empty()) return line("bounds", "none: there is no geometry");
  line("bounds",
       fmt::format("{} to {} m", formatPlace(s, geometry.boundsMin), formatPlace(s, geometry.boundsMax)));
}

nlohmann::json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// The same in the author's coordinates, with numbers as numbers.
nlohmann::json infoJson(const Scene& s, const scene::Geometry& geometry) {
  nlohmann::json made{{"name", s.name},
                      {"source", s.source},
                      {"hash", formatHash(s.hash)},
                      {"triangles", geometry.triangles.size()},
                      {"moving_triangles", geometry.triangles.size() - geometry.staticTriangles},
                      {"vertices", geometry.positions.size()},
                      {"objects", geometry.objects.size()},
                      {"materials", s.materials.size()},
                      {"textures", s.textures.size()},
                      {"exposure", s.exposure},
                      {"bounds", nullptr},
                      {"lights", nlohmann::json::array()},
                      {"cameras", nlohmann::json::array()},
                      {"animations", nlohmann::json::array()}};
  if (!geometry.empty())
    made["bounds"] = {vectorJson(scene::toAuthor(s, geometry.boundsMin)),
                      vectorJson(scene::toAuthor(s, geometry.boundsMax))};
  for (const scene::Light& light : s.lights) {
    const char* kind = light.type == scene::LightType::Directional ? "directional"
                       : light.type == scene::LightType::Point     ? "point"
                                                                   : "spot";
    made["lights"].push_back({{"name", light.name},
                              {"type", kind},
                              {"strength", vectorJson(light.color * light.intensity)},
                              {"position", vectorJson(scene::toAuthor(s, light.position))},
                              {"direction", vectorJson(light.direction)}});
  }
  for (const scene::Camera& c : s.cameras)
    made["cameras"].push_back({{"position", vectorJson(scene::toAuthor(s, c.position))},
                               {"direction", vectorJson(c.orientation * glm::vec3(0, 0, -1))},
                               {"fov_degrees", glm::degrees(c.verticalFov)}});
  for (const scene::Animation& a : s.animations)
    made["animations"].push_back({{"name", a.name},
                                  {"plays", a.plays},
                                  {"channels", a.channels.size()},
                                  {"seconds", scene::duration(a)}});
  if (s.environmentMap)
    made["environment"] = {{"width", s.environmentMap->width()}, {"height", s.environmentMap->height()}};
  else
    made["environment"] = vectorJson(s.environment);
  return made;
}

ExitCode info(const std::string& name, const scene::LoadOptions& options, bool asJson) {
  Diagnostics messages;
  const Scene s = scene::load(name, messages, options);
  const scene::Geometry geometry = scene::flatten(s);
  printWarnings(messages);
  if (asJson) {
    fmt::print("{}\n", infoJson(s, geometry).dump(2));
    return ExitCode::Ok;
  }
  line("scene", s.name);
  if (!s.source.empty()) line("source", s.source);
  printContents(s, geometry);
  for (const scene::Light& light : s.lights) line("light", formatLight(s, light));
  for (const scene::Camera& c : s.cameras)
    line("camera",
         fmt::format("at {}, towards {}, {:.3g} degrees high", formatPlace(s, c.position),
                     formatVector(c.orientation * glm::vec3(0, 0, -1)), glm::degrees(c.verticalFov)));
  if (!s.cameraPath.empty())
    line("path", fmt::format("{} camera keys over {:.3g} s", s.cameraPath.size(), s.cameraPath.back().time));
  for (const scene::Animation& a : s.animations)
    line(a.plays ? "plays" : "could play",
         fmt::format("{}, {} channels over {:.3g} s", a.name, a.channels.size(), scene::duration(a)));
  for (const scene::Mover& m : s.movers) line("moves", formatPath(s.nodes[m.node].name, m));
  for (const scene::LightMotion& m : s.lightMotions)
    line("moves", "light " + formatPath(s.lights[m.light].name, m));
  if (s.gaze.size() == 1)
    line("gaze", fmt::format("at {:.3g}, {:.3g}", s.gaze[0].position.x, s.gaze[0].position.y));
  if (s.gaze.size() > 1)
    line("gaze", fmt::format("{} samples over {:.3g} s", s.gaze.size(), s.gaze.back().time));
  line("exposure", fmt::format("{:.4g}", s.exposure));
  if (s.environmentMap)
    line("sky", fmt::format("a map of {}x{} texels", s.environmentMap->width(), s.environmentMap->height()));
  else
    line("sky", formatVector(s.environment) + " W/(sr m^2)");
  line("hash", formatHash(s.hash));
  if (s.assumed)
    fmt::print("\nas a scene file, to be changed:\n{}", scene::bareModelFile(s, options.environment));
  return ExitCode::Ok;
}

}  // namespace

void addScene(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("scene", "Look into scenes, export them")->require_subcommand(1);
  CLI::App* infoCommand = command->add_subcommand("info", "Print what a scene holds");
  auto name = std::make_shared<std::string>();
  infoCommand->add_option("SCENE", *name, "A .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("");
  auto options = std::make_shared<scene::LoadOptions>();
  addFollowLinksOption(*infoCommand);
  addEnvironmentOption(*infoCommand, options->environment);
  auto asJson = std::make_shared<bool>(false);
  addJsonFlag(*infoCommand, *asJson);
  infoCommand->callback([name, options, asJson, &action] {
    action = [name, options, asJson] { return info(*name, *options, *asJson); };
  });
  addSceneExport(*command, action);
}

}  // namespace fovea::cli
