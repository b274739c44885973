// The part of scene files that describes motion: nodes and meshes along keys, lights along keys.
#include <optional>
#include <type_traits>

#include "framework/scene/file/reader.h"
#include "framework/scene/load.h"
#include "framework/scene/origin.h"

namespace fovea::scene {

using json::ObjectReader;
using json::Value;

namespace {

void addFace(Primitive& p, const std::vector<glm::vec3>& corners) {
  const uint32_t base = uint32_t(p.positions.size());
  const glm::vec3 n = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  for (size_t i = 0; i < corners.size(); ++i) {
    p.positions.push_back(corners[i]);
    p.normals.push_back(n);
    p.uvs.push_back({i == 1 || i == 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f});
    if (i >= 2) p.indices.insert(p.indices.end(), {base, base + uint32_t(i) - 1, base + uint32_t(i)});
  }
}

// The cube of edge 1 about the origin.
Primitive box() {
  Primitive p;
  const auto at = [](int x, int y, int z) { return glm::vec3(x, y, z) - 0.5f; };
  addFace(p, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
  addFace(p, {at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0)});
  addFace(p, {at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1)});
  addFace(p, {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
  addFace(p, {at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0)});
  addFace(p, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
  return p;
}

// A folded sheet, 1 long and 1 wide, that flies along -Z: two wings that rise outwards from a keel.
Primitive paperPlane() {
  Primitive p;
  const glm::vec3 nose(0, 0, -0.5f), keel(0, -0.18f, 0.5f), fold(0.045f, 0, 0.5f), tip(0.5f, 0.09f, 0.5f);
  const auto left = [](glm::vec3 v) { return v * glm::vec3(-1, 1, 1); };
  addFace(p, {nose, fold, tip});
  addFace(p, {nose, left(tip), left(fold)});
  addFace(p, {nose, keel, fold});
  addFace(p, {nose, left(fold), keel});
  return p;
}

// Decomposes a matrix into translation, rotation and scale; false if it shears.
bool decompose(Node& node) {
  if (!node.matrix) return true;
  const glm::mat4 m = *node.matrix;
  Node n = node;
  n.matrix.reset();
  n.translation = glm::vec3(m[3]);
  glm::mat3 axes(m);
  n.scale = {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
  if (glm::determinant(axes) < 0) n.scale.x = -n.scale.x;
  for (int i = 0; i < 3; ++i) {
    if (n.scale[i] == 0) return false;
    axes[i] /= n.scale[i];
  }
  n.rotation = glm::normalize(glm::quat_cast(axes));
  const glm::mat4 again = localTransform(n);
  for (int i = 0; i < 3; ++i)
    if (!(glm::distance(glm::vec3(again[i]), glm::vec3(m[i])) <= 1e-4f * std::abs(n.scale[i]))) return false;
  node = n;
  return true;
}

}  // namespace

void MotionReader::read(ObjectReader& scene) {
  eachItem(scene, "movers", [&](const Value& v, const std::string& path) { mover(v, path); });
  eachItem(scene, "moving_lights", [&](const Value& v, const std::string& path) { movingLight(v, path); });
}

// Reads the keys, the interpolation between them and the repetition after them.
template <class Entry>
void MotionReader::how(ObjectReader& r, Entry& entry) {
  entry.smooth = r.choice("interpolation", "smooth", {"smooth", "linear"}) != "linear";
  const std::string repeat = r.choice("repeat", "once", {"once", "loop", "back_and_forth"});
  entry.repeat = repeat == "loop"             ? Repeat::Loop
                 : repeat == "back_and_forth" ? Repeat::PingPong
                                              : Repeat::Once;
  r.require("keys");
  eachItem(r, "keys", [&](const Value& v, const std::string& path) {
    if constexpr (std::is_same_v<Entry, MoverEntry>)
      moverKey(v, path, entry);
    else
      lightKey(v, path, entry);
  });
  if (const Value* list = r.value().find("keys"); list && list->isArray() && list->items.empty())
    mistake(r, "keys", "a path needs at least one key");
}

void MotionReader::mover(const Value& v, const std::string& path) {
  ObjectReader r(v, path, errors_);
  MoverEntry m;
  m.where = v.where.location();
  m.path = path;
  m.node = r.text("node");
  m.file = r.text("file");
  const bool hasShape = r.has("shape");
  if (hasShape) m.shape = r.choice("shape", "box", {"box", "paper_plane"});
  if (v.isObject() && int(!m.node.empty()) + int(!m.file.empty()) + int(hasShape) != 1)
    errors_.error(m.where, path, "what moves is named by one of `node`, `file` and `shape`");
  if (m.node.empty())
    m.name = r.text("name", m.file.empty() ? m.shape : std::filesystem::path(m.file).stem().string());
  if (!m.file.empty()) {
    m.get = r.text("get");
    m.scale = readScale(r, "scale", glm::vec3(1));
    readAnimation(r, m.animation);
  }
  if (hasShape) {
    m.scale = readScale(r, "size", glm::vec3(1));
    m.color = readReflectance(r, "color", glm::vec3(0.8f));
    m.emission = readColor(r, "emission", glm::vec3(0));
  }
  how(r, m);
  r.finish();
  movers_.push_back(std::move(m));
}

void MotionReader::moverKey(const Value& v, const std::string& path, MoverEntry& m) {
  ObjectReader r(v, path, errors_);
  PoseKey key;
  r.require("t");
  key.time = float(r.number("t", 0, 0, 1e6));
  if (!m.keys.empty() && r.has("t") && key.time <= m.keys.back().time)
    mistake(r, "t", "the times of a path must increase");
  if (r.has("translation")) key.translation = readPlace(r, "translation");
  if (r.has("rotation_deg"))
    key.rotation = glm::quat(glm::radians(readVector(r, "rotation_deg", glm::vec3(0))));
  if (const auto q = r.numbers("quaternion", 4)) {
    const auto part = [&](size_t i) { return float((*q)[i]); };
    const glm::quat rotation = glm::quat(part(3), part(0), part(1), part(2));
    const float length = glm::length(rotation);
    if (!(length > 1e-6f) || !std::isfinite(length))
      mistake(r, "quaternion", "a quaternion (x, y, z, w) cannot be zero");
    else
      key.rotation = rotation / length;
    if (r.has("rotation_deg"))
      mistake(r, "quaternion", "a rotation is given either in degrees or as a quaternion");
  }
  key.visible = r.boolean("visible", true);
  r.finish();
  m.keys.push_back(key);
}

void MotionReader::movingLight(const Value& v, const std::string& path) {
  ObjectReader r(v, path, errors_);
  LightEntry l;
  l.where = v.where.location();
  l.path = path;
  r.require("light");
  l.light = r.text("light");
  how(r, l);
  r.finish();
  lights_.push_back(std::move(l));
}

void MotionReader::lightKey(const Value& v, const std::string& path, LightEntry& l) {
  ObjectReader r(v, path, errors_);
  LightKeyEntry key;
  r.require("t");
  key.time = float(r.number("t", 0, 0, 1e6));
  if (!l.keys.empty() && r.has("t") && key.time <= l.keys.back().time)
    mistake(r, "t", "the times of a path must increase");
  if (r.has("position")) key.position = readPlace(r, "position");
  if (r.has("direction")) key.direction = readDirection(r, "direction", glm::vec3(0, -1, 0));
  if (r.has("color")) key.color = readColor(r, "color", glm::vec3(1));
  if (r.has("intensity")) key.intensity = float(r.number("intensity", 1, 0, 1e12));
  r.finish();
  l.keys.push_back(key);
}

void MotionReader::apply(Scene& scene, const std::filesystem::path& folder, Diagnostics& warnings) {
  for (const MoverEntry& m : movers_)
    if (const uint32_t node = nodeOf(m, scene, folder, warnings); node != kNoIndex)
      applyMover(m, node, scene);
  checkNested(scene);
  for (const LightEntry& l : lights_) applyLight(l, scene);
  errors_.throwIfErrors();
}

// Returns the node that moves, either one of a model or a new one.
uint32_t MotionReader::nodeOf(const MoverEntry& m, Scene& scene, const std::filesystem::path& folder,
                              Diagnostics& warnings) {
  if (!m.node.empty()) {
    std::vector<std::string> names;
    uint32_t found = kNoIndex, count = 0;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
      names.push_back(scene.nodes[i].name);
      if (scene.nodes[i].name != m.node) continue;
      found = i;
      ++count;
    }
    if (count == 1) return found;
    const std::string nearest = nearestName(m.node, names);
    errors_.error(m.where, m.path + ".node",
                  count == 0 ? "the models have no node `" + m.node + "`"
                             : std::to_string(count) + " nodes are called `" + m.node + "`: which one moves?",
                  count == 0 && !nearest.empty() ? "did you mean `" + nearest + "`?" : "");
    return kNoIndex;
  }
  const uint32_t node = uint32_t(scene.nodes.size());
  if (!m.file.empty()) {
    Placement placement;
    placement.name = m.name;
    placement.scale = m.scale;
    placement.lights = false;
    Scene model = loadGltf(findFile({"model", m.file, m.get, m.where, m.path + ".file"}, folder), warnings,
                           scene.fullMaterials);
    chooseAnimation(model, m.animation, errors_);
    model.cameras.clear();
    for (Node& n : model.nodes) n.camera = kNoIndex;
    appendModel(scene, std::move(model), placement);
    return node;
  }
  Primitive p = m.shape == "paper_plane" ? paperPlane() : box();
  p.material = uint32_t(scene.materials.size());
  Material material;
  material.name = m.name;
  material.baseColor = glm::vec4(m.color, 1);
  material.emission = m.emission;
  material.doubleSided = m.shape == "paper_plane";
  scene.materials.push_back(material);
  Node n;
  n.name = m.name;
  n.scale = m.scale;
  n.translation = fromAuthor(scene, glm::dvec3(0));
  n.mesh = uint32_t(scene.meshes.size());
  scene.meshes.push_back({m.name, {std::move(p)}});
  scene.nodes.push_back(n);
  return node;
}

void MotionReader::applyMover(const MoverEntry& m, uint32_t index, Scene& scene) {
  Node& node = scene.nodes[index];
  if (!decompose(node))
    return errors_.error(m.where, m.path,
                         "the matrix of node `" + node.name + "` shears or flattens it; it cannot move");
  node.dynamic = true;
  Mover mover{index, m.smooth, m.repeat, {}};
  const glm::dvec3 ownTranslation = authoredTranslation(scene, index);
  for (const PoseKey& k : m.keys) {
    const glm::quat rotation = k.rotation.value_or(node.rotation);
    mover.keys.push_back({k.time,
                          translationFrom(scene, index, k.translation.value_or(ownTranslation), rotation),
                          rotation, k.visible});
  }
  // What the mover has brought is at rest where it begins, and not at the author's origin, which may be far away.
  if (m.node.empty() && scene.origin != glm::dvec3(0)) node.translation = mover.keys.front().translation;
  scene.movers.push_back(std::move(mover));
}

void MotionReader::checkNested(const Scene& scene) {
  std::vector<uint32_t> moverOf(scene.nodes.size(), kNoIndex);
  for (uint32_t m = 0; m < scene.movers.size(); ++m) {
    uint32_t& entry = moverOf[scene.movers[m].node];
    if (entry != kNoIndex)
      errors_.error(movers_[m].where, movers_[m].path,
                    "node `" + scene.nodes[scene.movers[m].node].name + "` moves twice",
                    "join the two paths");
    entry = m;
  }
  for (uint32_t m = 0; m < scene.movers.size() && !errors_.hasErrors(); ++m)
    for (uint32_t n = scene.nodes[scene.movers[m].node].parent; n != kNoIndex; n = scene.nodes[n].parent)
      if (moverOf[n] != kNoIndex)
        errors_.error(movers_[m].where, movers_[m].path,
                      "node `" + scene.nodes[scene.movers[m].node].name + "` hangs on `" +
                          scene.nodes[n].name + "`, which moves already",
                      "move only one of them");
}

void MotionReader::applyLight(const LightEntry& l, Scene& scene) {
  std::vector<std::string> names;
  uint32_t found = kNoIndex, count = 0;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    names.push_back(scene.lights[i].name);
    if (scene.lights[i].name != l.light) continue;
    found = i;
    ++count;
  }
  if (count != 1) {
    const std::string nearest = nearestName(l.light, names);
    return errors_.error(
        l.where, l.path + ".light",
        count == 0 ? "there is no light `" + l.light + "`"
                   : std::to_string(count) + " lights are called `" + l.light + "`: which one moves?",
        count == 0 && !nearest.empty() ? "did you mean `" + nearest + "`?" : "give it a `name` of its own");
  }
  for (const LightMotion& m : scene.lightMotions)
    if (m.light == found)
      return errors_.error(l.where, l.path, "light `" + l.light + "` moves twice", "join the two paths");
  const Light& light = scene.lights[found];
  LightMotion motion{found, l.smooth, l.repeat, {}};
  for (const LightKeyEntry& k : l.keys)
    motion.keys.push_back({k.time, k.position ? fromAuthor(scene, *k.position) : light.position,
                           k.direction.value_or(light.direction), k.color.value_or(light.color),
                           k.intensity.value_or(light.intensity)});
  scene.lightMotions.push_back(std::move(motion));
}

}  // namespace fovea::scene
