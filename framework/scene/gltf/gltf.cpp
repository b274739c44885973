// Implements loadGltf, which loads a glTF 2.0 model as a Scene. gltf/internal.h explains the steps and the reasons
// for their order.
#include <tiny_gltf.h>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/load.h"

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

std::string nameOf(std::string_view array, size_t index, const std::string& name) {
  std::string text = std::string(array) + "[" + std::to_string(index) + "]";
  if (!name.empty()) text += " `" + name.substr(0, 80) + "`";
  return text;
}

}  // namespace gltf

Scene loadGltf(const std::filesystem::path& file, Diagnostics& warnings, bool fullMaterials) {
  Scene scene;
  scene.fullMaterials = fullMaterials;
  scene.name = file.stem().string();
  scene.source = file.string();
  try {
    const gltf::Source source = gltf::readSource(file);
    const json::Value root = json::parse(source.json, source.name);
    gltf::checkDocument(root, source, warnings);
    tinygltf::Model model;
    gltf::parseModel(source, root, model);
    gltf::decodeBufferViews(source, root, model);
    gltf::decodePrimitives(source, root, model);
    gltf::Context c{source, root, model, scene, warnings};
    gltf::buildMaterials(c);
    gltf::buildMeshes(c);
    gltf::buildNodes(c);
    gltf::buildSkins(c);
    gltf::buildAnimations(c);
    if (scene.materials.empty()) scene.materials.emplace_back().name = "default";
    if (scene.meshes.empty() || scene.nodes.empty())
      c.warn("", "the model shows nothing: no scene with a mesh in it");
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::OutOfMemory, file.string() + ": not enough memory to load the model");
  }
  scene.hash = contentHash(scene);
  return scene;
}

}  // namespace fovea::scene
