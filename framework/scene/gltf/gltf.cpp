// Implements loadGltf, which loads a glTF 2.0 model as a Scene. gltf/internal.h explains the steps and the reasons
// for their order.
#include <tiny_gltf.h>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/load.h"
#include "framework/scene/origin.h"

namespace fovea::scene {
namespace gltf {

void Context::warn(std::string path, std::string message, std::string remedy) const {
  warnings.warning({source.name, 0, 0}, std::move(path), std::move(message), std::move(remedy));
}

void Context::warnIfDiffuse(std::string path, std::string message, std::string remedy) const {
  if (!scene.fullMaterials) warn(std::move(path), std::move(message), std::move(remedy));
}

void Context::fail(std::string path, std::string message, std::string remedy) const {
  throw Error(
      ExitCode::BadInput,
      {{Severity::Error, {source.name, 0, 0}, std::move(path), std::move(message), std::move(remedy)}});
}

bool Context::attempt(const std::function<void()>& part, const std::string& consequence) const {
  try {
    part();
    return true;
  } catch (const Error& e) {
    if (e.code() != ExitCode::BadInput) throw;
    for (Diagnostic d : e.diagnostics()) {
      d.severity = Severity::Warning;
      d.message += ": " + consequence;
      warnings.add(std::move(d));
    }
    return false;
  }
}

std::string nameOf(std::string_view array, size_t index, const std::string& name) {
  std::string text = std::string(array) + "[" + std::to_string(index) + "]";
  if (!name.empty()) text += " `" + name.substr(0, 80) + "`";
  return text;
}

Scene parseGltf(std::vector<uint8_t> bytes, const std::filesystem::path& file, Diagnostics& warnings,
                bool fullMaterials) {
  Scene scene;
  scene.fullMaterials = fullMaterials;
  scene.name = file.stem().string();
  scene.source = file.string();
  const Source source = sourceOf(std::move(bytes), file);
  json::Value root = json::parse(source.json, source.name);
  checkDocument(root, source, warnings);
  tinygltf::Model model;
  parseModel(source, root, model);
  decodeBufferViews(source, root, model);
  decodePrimitives(source, root, model);
  Context c{source, root, model, scene, warnings};
  buildMaterials(c);
  buildMeshes(c);
  buildNodes(c);
  buildSkins(c);
  buildAnimations(c);
  recentre(scene, c.local);
  if (scene.materials.empty()) scene.materials.emplace_back().name = "default";
  if (scene.meshes.empty() || scene.nodes.empty())
    c.warn("", "the model shows nothing: no scene with a mesh in it");
  scene.hash = contentHash(scene);
  return scene;
}

}  // namespace gltf

Scene loadGltf(const std::filesystem::path& file, Diagnostics& warnings, bool fullMaterials) try {
  return gltf::parseGltf(gltf::readFile(file), file, warnings, fullMaterials);
} catch (const std::bad_alloc&) {
  throw Error(ExitCode::OutOfMemory, file.string() + ": not enough memory to load the model");
}

}  // namespace fovea::scene
