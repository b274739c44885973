#include "framework/scene/export/scene_file.h"

#include <nlohmann/json.hpp>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/export/files.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const glm::vec3& v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }
Json vector(const glm::vec2& v) { return {shortest(v.x), shortest(v.y)}; }

const char* repeatName(Repeat repeat) {
  return repeat == Repeat::Loop ? "loop" : repeat == Repeat::PingPong ? "back_and_forth" : "once";
}

template <class Motion>
void describe(Json& out, const Motion& motion) {
  out["interpolation"] = motion.smooth ? "smooth" : "linear";
  out["repeat"] = repeatName(motion.repeat);
  out["keys"] = Json::array();
}

Json moverJson(const Mover& mover, const std::string& node) {
  Json out = {{"node", node}};
  describe(out, mover);
  for (const MotionKey& k : mover.keys) {
    Json key = {
        {"t", shortest(k.time)},
        {"translation", vector(k.translation)},
        {"quaternion",
         {shortest(k.rotation.x), shortest(k.rotation.y), shortest(k.rotation.z), shortest(k.rotation.w)}}};
    if (!k.visible) key["visible"] = false;
    out["keys"].push_back(std::move(key));
  }
  return out;
}

Json vector(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json lightMotionJson(const Scene& scene, const LightMotion& motion, const std::string& light) {
  Json out = {{"light", light}};
  describe(out, motion);
  for (const LightKey& k : motion.keys)
    out["keys"].push_back({{"t", shortest(k.time)},
                           {"position", vector(authoredPlace(scene, k.position))},
                           {"direction", vector(k.direction)},
                           {"color", vector(k.color)},
                           {"intensity", shortest(k.intensity)}});
  return out;
}

Json cameraJson(const Scene& scene) {
  const std::vector<CameraKey>& path = scene.cameraPath;
  const Camera& first = path.front().camera;
  Json out = {{"near", shortest(first.zNear)}, {"far", shortest(first.zFar)}, {"path", Json::array()}};
  if (first.aspectRatio > 0) out["aspect"] = shortest(first.aspectRatio);
  for (const CameraKey& k : path) {
    const Camera& c = k.camera;
    const glm::dvec3 eye = authoredPlace(scene, c.position);
    out["path"].push_back({{"t", shortest(k.time)},
                           {"eye", vector(eye)},
                           {"target", vector(eye + glm::dvec3(c.orientation * glm::vec3(0, 0, -1)))},
                           {"up", vector(c.orientation * glm::vec3(0, 1, 0))},
                           {"fov_deg", shortest(glm::degrees(c.verticalFov))}});
  }
  return out;
}

Json gazeJson(const std::vector<GazeSample>& gaze) {
  Json list = Json::array();
  for (const GazeSample& g : gaze) {
    Json sample = {{"t", shortest(g.time)}, {"x", shortest(g.position.x)}, {"y", shortest(g.position.y)}};
    if (!g.valid) sample["valid"] = false;
    if (g.left) sample["left"] = vector(*g.left);
    if (g.right) sample["right"] = vector(*g.right);
    list.push_back(std::move(sample));
  }
  return list;
}

// The path of a mover that is an object of its own without ever moving: one key, at its place.
Mover resting(const Scene& scene, uint32_t node) {
  return {node, true, Repeat::Once, {{0, scene.nodes[node].translation, scene.nodes[node].rotation, true}}};
}

Json moversJson(const Scene& scene, const SceneFileNames& names, Diagnostics& warnings) {
  Json list = Json::array();
  std::vector<bool> moved(scene.nodes.size());
  const NodePoses poses(scene);
  for (const Mover& m : scene.movers) {
    list.push_back(moverJson(m, names.nodes[m.node]));
    moved[m.node] = true;
  }
  for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    bool below = false;
    for (uint32_t p = n.parent; p != kNoIndex && !below; p = scene.nodes[p].parent) below = moved[p];
    if (!n.dynamic || moved[i] || below || poses.animated(i)) continue;
    if (n.matrix)
      warnings.warning({scene.name, 0, 0}, "nodes",
                       "node `" + n.name + "` is placed by a matrix: exported as part of what never moves");
    else
      list.push_back(moverJson(resting(scene, i), names.nodes[i]));
    moved[i] = true;
  }
  return list;
}

// The animation that the model plays; a scene file can name only one.
Json modelJson(const Scene& scene, const SceneFileNames& names, Diagnostics& warnings) {
  Json model = {{"file", names.model}};
  if (scene.animations.empty()) return model;
  model["animation"] = false;
  for (size_t i = 0; i < scene.animations.size(); ++i) {
    const Animation& a = scene.animations[i];
    if (!a.plays || names.animations[i].empty()) continue;
    if (!model["animation"].is_boolean())
      warnings.warning({scene.name, 0, 0}, "animations",
                       "several animations play at once: of the exported model only `" +
                           scene.animations[0].name + "` does");
    else
      model["animation"] = {
          {"name", names.animations[i]}, {"speed", shortest(a.speed)}, {"repeat", repeatName(a.repeat)}};
  }
  return model;
}

}  // namespace

std::string sceneFileText(const Scene& scene, const SceneFileNames& names, Diagnostics& warnings) {
  Json root = {{"name", scene.name},
               {"models", Json::array({modelJson(scene, names, warnings)})},
               {"exposure", shortest(scene.exposure)},
               {"environment", vector(scene.environment)},
               {"ipd", shortest(scene.ipd)}};
  if (scene.environmentMap)
    root["environment"] = {{"file", names.environment},
                           {"turn_deg", shortest(glm::degrees(scene.environmentMap->turn()))}};
  if (scene.fullMaterials) root["materials"] = "full";
  if (scene.lens)
    root["lens"] = {{"outward_deg", shortest(glm::degrees(scene.lens->outward))},
                    {"inward_deg", shortest(glm::degrees(scene.lens->inward))},
                    {"up_deg", shortest(glm::degrees(scene.lens->up))},
                    {"down_deg", shortest(glm::degrees(scene.lens->down))}};
  if (!scene.cameraPath.empty()) root["camera"] = cameraJson(scene);
  if (!scene.gaze.empty()) root["gaze"] = gazeJson(scene.gaze);
  if (Json movers = moversJson(scene, names, warnings); !movers.empty()) root["movers"] = std::move(movers);
  for (const LightMotion& m : scene.lightMotions)
    root["moving_lights"].push_back(lightMotionJson(scene, m, names.lights[m.light]));
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fovea::scene
