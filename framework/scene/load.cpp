#include "framework/scene/load.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

#include "framework/base/budget.h"
#include "framework/base/paths.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/first_view/first_view.h"
#include "framework/scene/origin.h"

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

void addFolder(std::vector<fs::path>& list, const fs::path& folder) {
  std::error_code ec;
  if (!fs::is_directory(folder, ec)) return;
  const fs::path real = fs::weakly_canonical(folder, ec);
  for (const fs::path& known : list)
    if (known == real) return;
  list.push_back(real);
}

uint32_t shifted(uint32_t index, size_t by) { return index == kNoIndex ? kNoIndex : index + uint32_t(by); }

bool isModelFile(const fs::path& file) { return file.extension() == ".gltf" || file.extension() == ".glb"; }

void replaceEnvironment(Scene& scene, const LoadOptions& options) {
  if (options.environment.empty()) return;
  scene.environmentMap = loadEnvironment(options.environment, 1, 0);
  scene.hash = contentHash(scene);
}

// Loads a model on its own, with all that a picture of it needs.
Scene loadBareModel(const fs::path& file, Diagnostics& warnings, const LoadOptions& options) {
  Scene scene = loadGltf(file, warnings, true);
  replaceEnvironment(scene, options);
  const FirstView added = addFirstView(scene);
  std::string list;
  for (const std::string& what : {added.camera, added.floor, added.light, added.exposure})
    if (!what.empty()) list += (list.empty() ? "" : ", ") + what;
  if (!list.empty())
    warnings.warning({file.string(), 0, 0}, "", "what the model does not say is assumed: " + list,
                     "`fovea scene info` prints it for a scene file, in which it can be changed");
  scene.hash = contentHash(scene);
  return scene;
}

Scene loadFile(const fs::path& file, Diagnostics& warnings, const LoadOptions& options) {
  Scene scene = isModelFile(file) ? loadBareModel(file, warnings, options) : loadSceneFile(file, warnings);
  if (!isModelFile(file)) replaceEnvironment(scene, options);
  uint64_t indices = 0;
  for (const Node& n : scene.nodes)
    if (n.mesh != kNoIndex)
      for (const Primitive& p : scene.meshes[n.mesh].primitives) indices += p.indices.size();
  if (indices == 0)
    throw Error(ExitCode::BadInput,
                file.string() + ": the scene has no triangles, and points and lines are not drawn",
                "export the model with its surfaces as meshes of triangles");
  if (addLightLevels(scene)) scene.hash = contentHash(scene);
  return scene;
}

[[noreturn]] void unknownScene(const std::string& name) {
  const std::vector<std::string> known = names();
  std::string list;
  for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
  const std::string nearest = nearestName(name, known);
  throw Error(ExitCode::BadInput, "there is no scene `" + name + "`",
              (nearest.empty() ? "" : "did you mean `" + nearest + "`? ") + "known scenes: " + list +
                  "; or give a .json, .gltf or .glb file");
}

}  // namespace

std::vector<fs::path> modelSearchPath() {
  std::vector<fs::path> list;
  if (const char* variable = std::getenv("FOVEA_SCENES")) {
    std::stringstream folders(variable);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (!folder.empty()) addFolder(list, folder);
  }
  addFolder(list, fs::path(FOVEA_SOURCE_DIR) / ".." / "shared" / "scenes");
  std::error_code ec;
  addFolder(list, fs::current_path(ec) / ".." / "shared" / "scenes");
  return list;
}

std::vector<fs::path> sceneSearchPath() {
  std::vector<fs::path> list;
  for (const fs::path& folder : dataFolders("scenes")) {
    list.push_back(folder);
    std::error_code ec;
    std::vector<fs::path> below;
    for (const fs::directory_entry& e : fs::directory_iterator(folder, ec))
      if (e.is_directory(ec)) below.push_back(e.path());
    std::ranges::sort(below);
    list.insert(list.end(), below.begin(), below.end());
  }
  return list;
}

std::vector<std::string> names() {
  std::vector<std::string> names = builtinNames();
  std::error_code ec;
  for (const fs::path& folder : sceneSearchPath())
    for (const fs::directory_entry& e : fs::directory_iterator(folder, ec))
      if (e.path().extension() == ".json") names.push_back(e.path().stem().string());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Scene load(const std::string& nameOrFile, Diagnostics& warnings, const LoadOptions& options) {
  const ContentBudget budget;
  const fs::path file(nameOrFile);
  const bool asFile = file.has_parent_path() || file.extension() == ".json" || isModelFile(file);
  std::error_code ec;
  if (!asFile) {
    // A scene file with the name of a built-in scene adds its motion, so it takes precedence.
    for (const fs::path& folder : sceneSearchPath())
      if (const fs::path found = folder / (nameOrFile + ".json"); fs::is_regular_file(found, ec))
        return loadFile(found, warnings, options);
    for (const std::string& name : builtinNames())
      if (name == nameOrFile) {
        Scene scene = builtin(name);
        replaceEnvironment(scene, options);
        return scene;
      }
    unknownScene(nameOrFile);
  }
  if (fs::exists(file, ec)) {
    if (!isModelFile(file) && file.extension() != ".json")
      throw Error(ExitCode::BadInput,
                  nameOrFile + ": is neither a scene file (.json) nor a model (.gltf, .glb)");
    return loadFile(file, warnings, options);
  }
  if (!file.is_absolute())
    for (const fs::path& folder : isModelFile(file) ? modelSearchPath() : sceneSearchPath())
      if (fs::is_regular_file(folder / file, ec)) return loadFile(folder / file, warnings, options);
  throw Error(ExitCode::BadInput, nameOrFile + ": there is no such scene or model file");
}

glm::quat lookAlong(glm::vec3 direction, glm::vec3 up) {
  const glm::vec3 back = -glm::normalize(direction);
  glm::vec3 right = glm::cross(up, back);
  // When looking along `up`, any roll is valid, but it must always be the same.
  if (glm::length(right) < 1e-5f)
    right = glm::cross(std::abs(back.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0), back);
  right = glm::normalize(right);
  return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

Camera lookAt(glm::vec3 position, glm::vec3 target, glm::vec3 up) {
  Camera camera;
  camera.position = position;
  camera.orientation = lookAlong(target - position, up);
  return camera;
}

void appendModel(Scene& scene, Scene&& model, const Placement& placement) {
  Node root;
  root.name = placement.name;
  root.rotation = placement.rotation;
  root.scale = placement.scale;
  root.origin = model.origin;
  const size_t textures = scene.textures.size(), materials = scene.materials.size(),
               meshes = scene.meshes.size(), lights = scene.lights.size(), cameras = scene.cameras.size(),
               skins = scene.skins.size();
  const uint32_t rootIndex = uint32_t(scene.nodes.size());
  scene.nodes.push_back(root);
  scene.nodes.back().translation =
      translationFrom(scene, rootIndex, placement.translation, placement.rotation);
  const glm::mat4 world = localTransform(scene.nodes.back());
  for (Node& n : model.nodes) {
    n.parent = n.parent == kNoIndex ? rootIndex : n.parent + rootIndex + 1;
    n.mesh = shifted(n.mesh, meshes);
    n.light = placement.lights ? shifted(n.light, lights) : kNoIndex;
    n.camera = shifted(n.camera, cameras);
    n.skin = shifted(n.skin, skins);
    scene.nodes.push_back(std::move(n));
  }
  for (Texture& t : model.textures) scene.textures.push_back(std::move(t));
  for (Material& m : model.materials) {
    for (const auto use : kMaterialTextures) (m.*use).texture = shifted((m.*use).texture, textures);
    scene.materials.push_back(std::move(m));
  }
  for (Mesh& mesh : model.meshes) {
    for (Primitive& p : mesh.primitives) p.material += uint32_t(materials);
    scene.meshes.push_back(std::move(mesh));
  }
  for (Skin& s : model.skins) {
    for (uint32_t& joint : s.joints) joint = shifted(joint, rootIndex + 1);
    scene.skins.push_back(std::move(s));
  }
  for (Animation& a : model.animations) {
    for (AnimationChannel& c : a.channels) c.node = shifted(c.node, rootIndex + 1);
    scene.animations.push_back(std::move(a));
  }
  for (Light& l : model.lights) {
    if (!placement.lights) break;
    l.position = glm::vec3(world * glm::vec4(l.position, 1.0f));
    l.direction = placement.rotation * l.direction;
    scene.lights.push_back(std::move(l));
  }
  for (Camera& c : model.cameras) {
    c.position = glm::vec3(world * glm::vec4(c.position, 1.0f));
    c.orientation = placement.rotation * c.orientation;
    scene.cameras.push_back(std::move(c));
  }
}

}  // namespace fovea::scene
