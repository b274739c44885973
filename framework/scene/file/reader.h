// Helpers and types that the parts of the scene-file reader share. Private to framework/scene.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/json.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

inline std::string itemPath(const std::string& path, size_t i) {
  return path + "[" + std::to_string(i) + "]";
}

inline void mistake(json::ObjectReader& r, std::string_view key, const std::string& message,
                    const std::string& remedy = {}) {
  const json::Value* v = r.value().find(key);
  r.diagnostics().error((v ? *v : r.value()).where.location(), r.pathOf(key), message, remedy);
}

inline glm::vec3 readVector(json::ObjectReader& r, std::string_view key, glm::vec3 fallback) {
  const auto v = r.numbers(key, 3);
  return v ? glm::vec3((*v)[0], (*v)[1], (*v)[2]) : fallback;
}

// A place in the author's coordinates, which become those of the scene once its origin is known
// (framework/scene/origin.h).
inline glm::dvec3 readPlace(json::ObjectReader& r, std::string_view key) {
  const auto v = r.numbers(key, 3);
  return v ? glm::dvec3((*v)[0], (*v)[1], (*v)[2]) : glm::dvec3(0);
}

inline glm::vec3 readColor(json::ObjectReader& r, std::string_view key, glm::vec3 fallback) {
  const glm::vec3 c = readVector(r, key, fallback);
  if (c.x < 0 || c.y < 0 || c.z < 0) mistake(r, key, "a colour has no negative parts");
  return c;
}

inline glm::vec3 readReflectance(json::ObjectReader& r, std::string_view key, glm::vec3 fallback) {
  const glm::vec3 c = readColor(r, key, fallback);
  if (c.x > 1 || c.y > 1 || c.z > 1) mistake(r, key, "no surface reflects more than 1");
  return c;
}

inline glm::vec3 readDirection(json::ObjectReader& r, std::string_view key, glm::vec3 fallback) {
  const glm::vec3 d = readVector(r, key, fallback);
  const float length = glm::length(d);
  if (length > 1e-12f && std::isfinite(length)) return d / length;
  mistake(r, key, "a direction cannot be zero");
  return fallback;
}

// Reads one number or three; a scale of 0 is a mistake.
inline glm::vec3 readScale(json::ObjectReader& r, std::string_view key, glm::vec3 fallback) {
  const json::Value* v = r.find(key);
  if (!v) return fallback;
  const glm::vec3 s = v->isNumber() ? glm::vec3(float(r.number(key, 1))) : readVector(r, key, fallback);
  if (s.x == 0 || s.y == 0 || s.z == 0) mistake(r, key, "a scale of 0 leaves nothing to see");
  return s;
}

template <class Visit>
void eachItem(json::ObjectReader& r, std::string_view key, const Visit& visit) {
  const json::Value* list = r.array(key);
  for (size_t i = 0; list && list->isArray() && i < list->items.size(); ++i)
    visit(list->items[i], itemPath(r.pathOf(key), i));
}

// A file that a scene file names. It is looked for beside the scene file (`folder`), then along the search
// path for models.
struct NamedFile {
  std::string what;  // "model"
  std::string file, get;
  SourceLocation where;
  std::string path;  // place within the document
};
std::filesystem::path findFile(const NamedFile& named, const std::filesystem::path& folder);

// The entry `subdivision` of a model.
struct SubdivisionEntry {
  SourceLocation where;
  std::string path;
  uint32_t level = 1;
  std::optional<uint32_t> lightLevel;  // level that voxels and maps of secondary lights see; `level` if none
  bool loop = true;                    // scheme of meshes that are not cages yet; if false, Catmull-Clark
  float creaseDegrees = 180;           // edges with a larger angle stay sharp
  std::vector<std::string> meshes;     // if empty, all meshes
};
SubdivisionEntry readSubdivision(const json::Value& v, const std::string& path, Diagnostics& errors);
// Turns the model's meshes into cages and refines them; meshes that are cages already only take the
// level. Throws Error(BadInput).
void applySubdivision(const SubdivisionEntry& entry, Scene& model);

// Reads gaze samples from an array of the scene file; readGazeCsv() (motion.h) reads a table.
std::vector<GazeSample> readGaze(const json::Value& list, Diagnostics& errors);
// A table in memory; `file` is its name in messages.
std::vector<GazeSample> parseGazeCsv(std::string_view text, const std::string& file);

// The entry `animation` of a model: its name or number, or { "name", "speed", "repeat" }.
struct AnimationChoice {
  SourceLocation where;
  std::string path;  // if empty, not given: the model plays what it plays by default
  std::string name;
  std::optional<int64_t> index;
  bool none = false;
  float speed = 1;
  Repeat repeat = Repeat::Loop;
};
void readAnimation(json::ObjectReader& model, AnimationChoice& choice);
void chooseAnimation(Scene& model, const AnimationChoice& choice, Diagnostics& errors);

// Reads `movers` and `moving_lights` with the rest of the file and applies them once the models are loaded.
class MotionReader {
 public:
  explicit MotionReader(Diagnostics& errors) : errors_(errors) {}
  void read(json::ObjectReader& scene);
  // Appends the models and shapes that movers bring, and finds the nodes and lights that they
  // name. Throws Error(BadInput).
  void apply(Scene& scene, const std::filesystem::path& folder, Diagnostics& warnings);

 private:
  struct PoseKey {
    float time = 0;
    std::optional<glm::dvec3> translation;  // the author's
    std::optional<glm::quat> rotation;
    bool visible = true;
  };
  struct MoverEntry {
    SourceLocation where;
    std::string path, node, name, shape, file, get;
    AnimationChoice animation{};
    glm::vec3 size{1}, color{0.8f}, emission{0}, scale{1};
    bool smooth = true;
    Repeat repeat = Repeat::Once;
    std::vector<PoseKey> keys;
  };
  struct LightKeyEntry {
    float time = 0;
    std::optional<glm::dvec3> position;  // the author's
    std::optional<glm::vec3> direction, color;
    std::optional<float> intensity;
  };
  struct LightEntry {
    SourceLocation where;
    std::string path, light;
    bool smooth = true;
    Repeat repeat = Repeat::Once;
    std::vector<LightKeyEntry> keys;
  };
  void mover(const json::Value& v, const std::string& path);
  void moverKey(const json::Value& v, const std::string& path, MoverEntry& m);
  void movingLight(const json::Value& v, const std::string& path);
  void lightKey(const json::Value& v, const std::string& path, LightEntry& l);
  template <class Entry>
  void how(json::ObjectReader& r, Entry& entry);
  uint32_t nodeOf(const MoverEntry& m, Scene& scene, const std::filesystem::path& folder,
                  Diagnostics& warnings);
  void applyMover(const MoverEntry& m, uint32_t node, Scene& scene);
  void applyLight(const LightEntry& l, Scene& scene);
  void checkNested(const Scene& scene);

  Diagnostics& errors_;
  std::vector<MoverEntry> movers_;
  std::vector<LightEntry> lights_;
};

}  // namespace fovea::scene
