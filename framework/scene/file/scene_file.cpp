// Reads a scene file: models, lights, camera, exposure and gaze as data (samples/scenes/README.md).
#include "framework/scene/file/scene_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/environment/sky.h"
#include "framework/scene/file/reader.h"
#include "framework/scene/first_view/first_view.h"
#include "framework/scene/floor.h"
#include "framework/scene/load.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/origin.h"

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

using json::ObjectReader;
using json::Value;

constexpr size_t kMaxModels = 10000;                 // each is loaded by itself
constexpr uintmax_t kMaxBytes = uintmax_t(8) << 20;  // kMaxModels of 800 bytes each

struct ModelEntry {
  std::string file, builtin, get;
  SourceLocation where;
  std::string path;
  Placement placement;
  std::optional<SubdivisionEntry> subdivision;
  AnimationChoice animation;
};

struct Look {
  glm::dvec3 eye{0}, target{0, 0, -1};
  glm::vec3 up{0, 1, 0};
};

struct EnvironmentEntry {
  NamedFile file;
  float intensity = 1, turn = 0;  // turn: radians
};

class Parser {
 public:
  Parser(const Value& root, const fs::path& file) : root_(root) {
    scene_.source = file.string();
    scene_.name = file.stem().string();
  }

  // Everything but the models themselves.
  void parse() {
    ObjectReader r(root_, "", errors_);
    r.text("$schema");
    r.text("description");
    scene_.name = r.text("name", scene_.name);
    if (const Value* list = root_.find("models"); list && list->items.size() > kMaxModels)
      return tooManyModels(r, list->items.size());
    eachItem(r, "models", [&](const Value& v, const std::string& path) { model(v, path); });
    if (root_.isObject() && !r.has("models"))
      mistake(r, "models", "the scene has no `models`",
              R"(add "models": [{"file": "folder/model.gltf"}] or [{"builtin": "NAME"}])");
    eachItem(r, "lights", [&](const Value& v, const std::string& path) { light(v, path); });
    if (const Value* c = r.find("camera")) camera(*c);
    if (const Value* f = r.object("floor")) floor(*f);
    scene_.fullMaterials = r.choice("materials", "diffuse", {"diffuse", "full"}) == "full";
    hasExposure_ = r.has("exposure");
    scene_.exposure = float(r.number("exposure", 1.0, 1e-12, 1e12));
    hasEnvironment_ = r.has("environment");
    if (const Value* e = r.find("environment"); e && e->isObject())
      environment(*e);
    else
      scene_.environment = readColor(r, "environment", glm::vec3(0));
    scene_.ipd = float(r.number("ipd", scene_.ipd, 0, 10));
    if (const Value* l = r.find("lens")) lens(*l);
    gaze(r);
    motion_.read(r);
    r.finish();
    errors_.throwIfErrors();
  }

  Scene assemble(const fs::path& folder, Diagnostics& warnings) {
    Scene out = std::move(scene_);
    if (gazeFile_) out.gaze = readGazeCsv(findFile(*gazeFile_, folder));
    std::vector<Scene> models;
    std::vector<DoubleBounds> parts;
    for (const ModelEntry& m : models_) {
      Scene& model = models.emplace_back(
          m.builtin.empty() ? loadGltf(findFile({"model", m.file, m.get, m.where, m.path + ".file"}, folder),
                                       warnings, out.fullMaterials)
                            : builtin(m.builtin));
      if (!hasExposure_ && !m.builtin.empty()) out.exposure = model.exposure;
      if (!hasEnvironment_ && !m.builtin.empty()) out.environment = model.environment;
      if (out.gaze.empty()) out.gaze = model.gaze;
      if (m.subdivision) applySubdivision(*m.subdivision, model);
      chooseAnimation(model, m.animation, errors_);
      for (const DoubleBounds& part : authoredParts(model))
        parts.emplace_back().include(part, exactTransform(m.placement));
    }
    errors_.throwIfErrors();
    out.origin = originOf(boundsOfMost(parts));
    placeAll(out);
    for (size_t i = 0; i < models.size(); ++i) appendModel(out, std::move(models[i]), models_[i].placement);
    if (floor_) addFloor(out, *floor_);
    if (environment_)
      out.environmentMap =
          loadEnvironment(findFile(environment_->file, folder), environment_->intensity, environment_->turn);
    if (sky_) addDaylight(out, *sky_, hasSun_);
    motion_.apply(out, folder, warnings);
    return out;
  }

 private:
  void tooManyModels(ObjectReader& r, size_t count) {
    mistake(r, "models",
            std::to_string(count) + " models; a scene file may have " + std::to_string(kMaxModels),
            "put parts that belong together into one glTF model, whose nodes share meshes");
    errors_.throwIfErrors();
  }

  void model(const Value& v, const std::string& path) {
    ObjectReader r(v, path, errors_);
    ModelEntry m;
    m.where = v.where.location();
    m.path = path;
    m.file = r.text("file");
    m.builtin = r.text("builtin");
    m.get = r.text("get");
    if (v.isObject() && m.file.empty() == m.builtin.empty())
      errors_.error(m.where, path, "a model is named either by `file` or by `builtin`");
    const std::vector<std::string> names = builtinNames();
    if (!m.builtin.empty() && names.empty())
      errors_.error(m.where, r.pathOf("builtin"), "the program has no built-in scenes",
                    "a program of yours registers them with fovea::scenes::registerAll()");
    else if (!m.builtin.empty() && std::find(names.begin(), names.end(), m.builtin) == names.end())
      r.choice("builtin", "", names);
    Placement& p = m.placement;
    p.name = r.text("name", m.builtin.empty() ? fs::path(m.file).stem().string() : m.builtin);
    p.translation = readPlace(r, "translate");
    p.rotation = glm::quat(glm::radians(readVector(r, "rotate", glm::vec3(0))));
    p.scale = readScale(r, "scale", glm::vec3(1));
    p.lights = r.boolean("lights", true);
    if (const Value* s = r.object("subdivision"))
      m.subdivision = readSubdivision(*s, r.pathOf("subdivision"), errors_);
    readAnimation(r, m.animation);
    r.finish();
    models_.push_back(std::move(m));
  }

  void light(const Value& v, const std::string& path) {
    ObjectReader r(v, path, errors_);
    Light l;
    glm::dvec3 place(0);
    const std::string type = r.require("type") ? r.choice("type", "", {"directional", "point", "spot"}) : "";
    if (type.empty()) return;  // its other members depend on the type
    l.type = type == "directional" ? LightType::Directional
             : type == "spot"      ? LightType::Spot
                                   : LightType::Point;
    l.name = r.text("name", type);
    l.color = readColor(r, "color", glm::vec3(1));
    l.intensity = float(r.number("intensity", 1, 0, 1e12));
    if (l.type != LightType::Directional) {
      r.require("position");
      place = readPlace(r, "position");
      l.range = float(r.number("range", 0, 0, 1e12));
    }
    if (l.type != LightType::Point) {
      r.require("direction");
      l.direction = readDirection(r, "direction", glm::vec3(0, -1, 0));
    }
    if (l.type == LightType::Spot) {
      const double inner = r.number("inner_cone_deg", 0, 0, 90),
                   outer = r.number("outer_cone_deg", 45, 0, 90);
      if (inner > outer)
        mistake(r, "outer_cone_deg", "outer_cone_deg must not be smaller than inner_cone_deg");
      l.innerConeAngle = float(glm::radians(inner));
      l.outerConeAngle = float(glm::radians(outer));
    }
    r.finish();
    scene_.lights.push_back(l);
    lightPlaces_.push_back(place);
  }

  void camera(const Value& v) {
    ObjectReader r(v, "camera", errors_);
    const double fov = r.number("fov_deg", 50, 1, 170), aspect = r.number("aspect", 0, 0, 1000);
    const glm::vec3 up = readDirection(r, "up", glm::vec3(0, 1, 0));
    Camera base;
    base.name = "scene";
    base.aspectRatio = float(aspect);
    base.zNear = float(r.number("near", 0.05, 1e-5, 1e6));
    base.zFar = float(r.number("far", 0, 0, 1e9));
    if (base.zFar != 0 && base.zFar <= base.zNear) mistake(r, "far", "`far` must be larger than `near`");
    if (r.has("path")) {
      eachItem(r, "path",
               [&](const Value& key, const std::string& path) { cameraKey(key, path, base, up, fov); });
      if (const Value* list = r.value().find("path"); list->isArray() && list->items.empty())
        mistake(r, "path", "a camera path needs at least one key");
    } else {
      look(r, base, up, fov);
      scene_.cameras.push_back(base);
    }
    r.finish();
  }

  void cameraKey(const Value& v, const std::string& path, Camera base, glm::vec3 up, double fov) {
    ObjectReader r(v, path, errors_);
    r.require("t");
    CameraKey key;
    key.time = float(r.number("t", 0, 0, 1e6));
    if (!scene_.cameraPath.empty() && r.has("t") && key.time <= scene_.cameraPath.back().time)
      mistake(r, "t", "the times of a path must increase");
    fov = r.number("fov_deg", fov, 1, 170);
    up = readDirection(r, "up", up);
    look(r, base, up, fov);
    key.camera = base;
    r.finish();
    scene_.cameraPath.push_back(key);
  }

  // The camera is placed once the origin of the scene is known.
  void look(ObjectReader& r, Camera& camera, glm::vec3 up, double fov) {
    camera.verticalFov = float(glm::radians(fov));
    Look& look = looks_.emplace_back();
    look.up = up;
    if (!r.require("eye") || !r.require("target")) return;
    look.eye = readPlace(r, "eye");
    look.target = readPlace(r, "target");
    const double distance = glm::length(look.target - look.eye);
    if (!std::isfinite(glm::length(glm::vec3(look.eye))) || !std::isfinite(float(distance)))
      return mistake(r, "eye", "`eye` or `target` is too far away for single precision");
    if (distance <= 1e-6) return mistake(r, "target", "`eye` and `target` are the same point");
  }

  void placeCamera(const Scene& scene, const Look& look, Camera& camera) const {
    camera.position = fromAuthor(scene, look.eye);
    camera.orientation = lookAlong(fromAuthor(scene, look.target) - camera.position, look.up);
  }

  // What the file says in the author's coordinates, apart from models and movers.
  void placeAll(Scene& scene) {
    for (size_t i = 0; i < lightPlaces_.size(); ++i)
      if (scene.lights[i].type != LightType::Directional)
        scene.lights[i].position = fromAuthor(scene, lightPlaces_[i]);
    for (size_t i = 0; i < scene.cameraPath.size(); ++i)
      placeCamera(scene, looks_[i], scene.cameraPath[i].camera);
    if (!scene.cameraPath.empty())
      scene.cameras.push_back(scene.cameraPath.front().camera);
    else if (!scene.cameras.empty())
      placeCamera(scene, looks_[0], scene.cameras[0]);
    if (floor_) floor_->position = fromAuthor(scene, floorPlace_);
  }

  static glm::dmat4 exactTransform(const Placement& p) {
    glm::dmat4 m = glm::mat4_cast(glm::dquat(p.rotation));
    for (int axis = 0; axis < 3; ++axis) m[axis] *= double(p.scale[axis]);
    m[3] = glm::dvec4(p.translation, 1);
    return m;
  }

  void environment(const Value& v) {
    ObjectReader r(v, "environment", errors_);
    if (r.has("sky")) {
      if (r.has("file")) mistake(r, "file", "an environment is named either by `file` or by `sky`");
      r.text("file");
      if (const Value* s = r.object("sky")) sky(*s);
      return r.finish();
    }
    r.require("file");
    EnvironmentEntry e;
    e.file = {"environment", r.text("file"), "", v.where.location(), "environment.file"};
    e.intensity = float(r.number("intensity", 1, 0, 1e12));
    e.turn = float(glm::radians(r.number("turn_deg", 0, -360, 360)));
    r.finish();
    environment_ = e;
  }

  void sky(const Value& v) {
    ObjectReader r(v, "environment.sky", errors_);
    Sky s;
    s.turbidity = float(r.number("turbidity", double(s.turbidity), kLeastTurbidity, kMostTurbidity));
    s.sunElevation = float(glm::radians(r.number("sun_elevation_deg", 40, 0, 90)));
    s.sunAzimuth = float(glm::radians(r.number("sun_azimuth_deg", 0, -360, 360)));
    s.illuminance = float(r.number("illuminance", double(s.illuminance), 1e-6, 1e12));
    s.ground = readReflectance(r, "ground", s.ground);
    hasSun_ = r.boolean("sun", true);
    r.finish();
    sky_ = s;
  }

  void floor(const Value& v) {
    ObjectReader r(v, "floor", errors_);
    r.require("position");
    r.require("radius");
    Floor f;
    floorPlace_ = readPlace(r, "position");
    f.radius = float(r.number("radius", f.radius, 1e-6, 1e9));
    f.color = readReflectance(r, "color", f.color);
    r.finish();
    floor_ = f;
  }

  void lens(const Value& v) {
    ObjectReader r(v, "lens", errors_);
    const auto angle = [&](const char* key) {
      r.require(key);
      return float(glm::radians(r.number(key, 45, kLeastLensAngle, kMostLensAngle)));
    };
    scene_.lens = Lens{angle("outward_deg"), angle("inward_deg"), angle("up_deg"), angle("down_deg")};
    r.finish();
  }

  // An array of samples, or the name of a table.
  void gaze(ObjectReader& r) {
    const Value* v = r.find("gaze");
    if (!v) return;
    if (v->isString())
      gazeFile_ = {"gaze file", v->string, "", v->where.location(), "gaze"};
    else if (r.array("gaze"))
      scene_.gaze = readGaze(*v, errors_);
  }

  const Value& root_;
  Scene scene_;
  std::vector<ModelEntry> models_;
  Diagnostics errors_;
  MotionReader motion_{errors_};
  std::optional<NamedFile> gazeFile_;
  std::optional<EnvironmentEntry> environment_;
  std::optional<Sky> sky_;
  bool hasSun_ = true;
  std::optional<Floor> floor_;
  // In the author's coordinates: of scene_.lights; of the camera or of the keys of its path; of the floor.
  std::vector<glm::dvec3> lightPlaces_;
  std::vector<Look> looks_;
  glm::dvec3 floorPlace_{0};
  bool hasExposure_ = false, hasEnvironment_ = false;
};

void warnOfDarkness(const Scene& scene, Diagnostics& warnings) {
  const bool lit = !scene.lights.empty() || scene.environment != glm::vec3(0) || scene.environmentMap ||
                   std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const Material& m) { return m.emission != glm::vec3(0); });
  if (!lit)
    warnings.warning({scene.source, 0, 0}, "lights", "this scene has no light: the picture will be black",
                     "add `lights`");
}

}  // namespace

// Beside the scene file, then along the search path.
fs::path findFile(const NamedFile& m, const fs::path& folder) {
  std::vector<fs::path> folders = {folder};
  const std::vector<fs::path> search = modelSearchPath();
  folders.insert(folders.end(), search.begin(), search.end());
  std::string tried;
  std::error_code ec;
  for (const fs::path& f : folders) {
    const fs::path candidate = f / m.file;  // an absolute m.file replaces f
    if (fs::is_regular_file(candidate, ec)) return candidate;
    if (tried.find(candidate.string()) == std::string::npos)
      tried += (tried.empty() ? "" : ", ") + candidate.string();
  }
  std::string remedy =
      "put it there, or name the folder that holds it in the environment variable FOVEA_SCENES";
  if (!m.get.empty()) remedy = m.get + "; then " + remedy;
  throw Error(ExitCode::BadInput,
              {{Severity::Error, m.where, m.path,
                "the " + m.what + " `" + m.file + "` is missing; looked for " + tried, remedy}});
}

Scene parseSceneFile(const Value& root, const fs::path& file, Diagnostics& warnings) {
  Parser parser(root, file);
  parser.parse();
  Scene scene = parser.assemble(file.parent_path(), warnings);
  if (scene.materials.empty()) scene.materials.emplace_back().name = "default";
  if (scene.cameras.empty()) {
    const std::string added = addFirstCamera(scene, flatten(scene));
    warnings.warning({file.string(), 0, 0}, "camera", "the scene has no camera: " + added + " is assumed",
                     "`fovea scene info` prints it to be copied");
  }
  warnOfDarkness(scene, warnings);
  scene.hash = contentHash(scene);
  return scene;
}

Scene loadSceneFile(const fs::path& file, Diagnostics& warnings) {
  std::error_code unknown;
  const uintmax_t bytes = fs::file_size(file, unknown);
  if (!unknown && bytes > kMaxBytes)
    throw Error(ExitCode::BadInput,
                file.string() + " has " + std::to_string(bytes) + " bytes; a scene file may have " +
                    std::to_string(kMaxBytes),
                "put parts that belong together into one glTF model, and a long gaze into a table");
  return parseSceneFile(json::parseFile(file), file, warnings);
}

}  // namespace fovea::scene
