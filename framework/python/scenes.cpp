// Scenes: loaded, or made of arrays.
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <optional>

#include "fovea/scene.h"
#include "framework/python/casters.h"
#include "framework/python/module.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;
using namespace scene;

namespace {

template <class T, int N>
using Rows = nb::ndarray<const T, nb::shape<-1, N>, nb::c_contig, nb::device::cpu>;

template <class V, class Array>
std::vector<V> vectorsOf(const Array& rows) {
  std::vector<V> list(rows.shape(0));
  std::memcpy(list.data(), rows.data(), rows.nbytes());
  return list;
}

// Triangles of one material, which stand still or move along keys.
struct MeshObject {
  std::string name;
  Primitive primitive;
  Node node;
  std::vector<MotionKey> motion;
  Repeat repeat = Repeat::Once;
  bool smooth = true;
};

MeshObject makeMesh(const Rows<float, 3>& positions, const Rows<uint32_t, 3>& triangles, uint32_t material,
                    const std::optional<Rows<float, 3>>& normals, const std::optional<Rows<float, 2>>& uvs,
                    std::string name, glm::vec3 translation, glm::quat rotation, glm::vec3 scale,
                    std::vector<MotionKey> motion, Repeat repeat, bool smooth) {
  MeshObject mesh{std::move(name), {}, {}, std::move(motion), repeat, smooth};
  mesh.primitive.positions = vectorsOf<glm::vec3>(positions);
  mesh.primitive.indices.assign(triangles.data(), triangles.data() + triangles.size());
  if (normals) mesh.primitive.normals = vectorsOf<glm::vec3>(*normals);
  if (uvs) mesh.primitive.uvs = vectorsOf<glm::vec2>(*uvs);
  mesh.primitive.material = material;
  mesh.node.name = mesh.name;
  mesh.node.translation = translation;
  mesh.node.rotation = rotation;
  mesh.node.scale = scale;
  mesh.node.dynamic = !mesh.motion.empty();
  return mesh;
}

std::shared_ptr<Scene> makeScene(const std::vector<MeshObject>& meshes, std::vector<Material> materials,
                                 std::vector<Light> lights, std::vector<Camera> cameras,
                                 const std::vector<std::pair<float, Camera>>& cameraPath,
                                 const std::vector<std::pair<float, glm::vec2>>& gaze, float exposure,
                                 glm::vec3 environment, bool fullMaterials, std::string name) {
  auto scene = std::make_shared<Scene>();
  scene->name = scene->source = std::move(name);
  scene->materials = std::move(materials);
  scene->lights = std::move(lights);
  scene->cameras = std::move(cameras);
  for (const MeshObject& mesh : meshes) {
    const auto number = uint32_t(scene->meshes.size());
    scene->meshes.push_back({mesh.name, {mesh.primitive}});
    scene->nodes.push_back(mesh.node);
    scene->nodes.back().mesh = number;
    if (!mesh.motion.empty()) scene->movers.push_back({number, mesh.smooth, mesh.repeat, mesh.motion});
  }
  for (const auto& [time, camera] : cameraPath) scene->cameraPath.push_back({time, camera});
  for (const auto& [time, position] : gaze) scene->gaze.push_back({time, position, true, {}, {}});
  scene->exposure = exposure;
  scene->environment = environment;
  scene->fullMaterials = fullMaterials;
  complete(*scene);
  return scene;
}

std::pair<std::shared_ptr<Scene>, std::vector<Diagnostic>> loadScene(const std::string& nameOrFile,
                                                                     const std::string& environment) {
  const nb::gil_scoped_release released;
  Diagnostics messages;
  auto scene = std::make_shared<Scene>(load(nameOrFile, messages, {environment}));
  return {std::move(scene), messages.list()};
}

size_t trianglesOf(const Scene& scene) {
  size_t indices = 0;
  for (const Node& node : scene.nodes)
    if (node.mesh != kNoIndex)
      for (const Primitive& p : scene.meshes[node.mesh].primitives) indices += p.indices.size();
  return indices / 3;
}

void addThings(nb::module_& module) {
  nb::class_<Material>(module, "Material", "A surface. Colours are linear.")
      .def(
          "__init__",
          [](Material* self, glm::vec4 baseColor, float metallic, float roughness, glm::vec3 emission,
             bool doubleSided, float ior, float transmission, std::string name) {
            auto* m = new (self) Material();
            m->name = std::move(name), m->baseColor = baseColor;
            m->metallic = metallic, m->roughness = roughness, m->emission = emission;
            m->doubleSided = doubleSided, m->ior = ior, m->transmission = transmission;
          },
          nb::kw_only(), "base_color"_a = glm::vec4(1), "metallic"_a = 0.0f, "roughness"_a = 1.0f,
          "emission"_a = glm::vec3(0), "double_sided"_a = false, "ior"_a = 1.5f, "transmission"_a = 0.0f,
          "name"_a = "",
          "base_color: reflectance and alpha. emission: radiance, W/(sr m^2). roughness: the square root of "
          "GGX's\n"
          "alpha. ior: index of refraction. transmission: share of the light below the surface that goes "
          "on.\n"
          "Diffuse scenes use only the base color, the metallic share and the emission.")
      .def_rw("name", &Material::name)
      .def_rw("base_color", &Material::baseColor)
      .def_rw("metallic", &Material::metallic)
      .def_rw("roughness", &Material::roughness)
      .def_rw("emission", &Material::emission)
      .def_rw("double_sided", &Material::doubleSided)
      .def_rw("ior", &Material::ior)
      .def_rw("transmission", &Material::transmission);
  nb::enum_<LightType>(module, "LightType", "What kind of light it is.")
      .value("DIRECTIONAL", LightType::Directional)
      .value("POINT", LightType::Point)
      .value("SPOT", LightType::Spot);
  nb::class_<Light>(module, "Light", "A light without extent.")
      .def(
          "__init__",
          [](Light* self, LightType type, glm::vec3 position, glm::vec3 direction, glm::vec3 color,
             float intensity, float range, float inner, float outer, std::string name) {
            new (self)
                Light{std::move(name), type, color, intensity, range, inner, outer, position, direction};
          },
          nb::kw_only(), "type"_a, "position"_a = glm::vec3(0), "direction"_a = glm::vec3(0, 0, -1),
          "color"_a = glm::vec3(1), "intensity"_a = 1.0f, "range"_a = 0.0f, "inner_cone_angle"_a = 0.0f,
          "outer_cone_angle"_a = 0.78539816f, "name"_a = "",
          "color * intensity: W/m^2 for directional lights, W/sr for others. position: metres, world space.\n"
          "direction: of unit length, away from the light. range: metres, 0 for unlimited. Angles: radians.")
      .def_rw("name", &Light::name)
      .def_rw("type", &Light::type)
      .def_rw("position", &Light::position)
      .def_rw("direction", &Light::direction)
      .def_rw("color", &Light::color)
      .def_rw("intensity", &Light::intensity)
      .def_rw("range", &Light::range)
      .def_rw("inner_cone_angle", &Light::innerConeAngle)
      .def_rw("outer_cone_angle", &Light::outerConeAngle);
  nb::class_<Camera>(module, "Camera", "Looks along its -Z, and its +Y is up.")
      .def(
          "__init__",
          [](Camera* self, glm::vec3 position, glm::quat orientation, float verticalFov, float zNear,
             float zFar, std::string name) {
            new (self) Camera{std::move(name), position, orientation, verticalFov, zNear, zFar};
          },
          nb::kw_only(), "position"_a = glm::vec3(0), "orientation"_a = glm::quat(1, 0, 0, 0),
          "vertical_fov"_a = 0.8f, "z_near"_a = 0.05f, "z_far"_a = 0.0f, "name"_a = "",
          "position: metres, world space. orientation: a quaternion x, y, z, w. vertical_fov: radians. "
          "z_far: metres,\n"
          "0 to follow from the size of the scene.")
      .def_static(
          "look_at",
          [](glm::vec3 position, glm::vec3 target, glm::vec3 up, float verticalFov) {
            Camera camera = lookAt(position, target, up);
            camera.verticalFov = verticalFov;
            return camera;
          },
          "position"_a, "target"_a, "up"_a = glm::vec3(0, 1, 0), "vertical_fov"_a = 0.8f,
          "A camera at `position` that looks at `target`, both in metres.")
      .def_rw("name", &Camera::name)
      .def_rw("position", &Camera::position)
      .def_rw("orientation", &Camera::orientation)
      .def_rw("vertical_fov", &Camera::verticalFov)
      .def_rw("z_near", &Camera::zNear)
      .def_rw("z_far", &Camera::zFar)
      .def("__getstate__",
           [](const Camera& c) {
             return std::tuple(c.name, c.position, c.orientation, c.verticalFov, c.zNear, c.zFar);
           })
      .def("__setstate__",
           [](Camera& self, const std::tuple<std::string, glm::vec3, glm::quat, float, float, float>& state) {
             const auto& [name, position, orientation, fov, zNear, zFar] = state;
             new (&self) Camera{name, position, orientation, fov, zNear, zFar};
           });
}

void addMeshes(nb::module_& module) {
  nb::enum_<Repeat>(module, "Repeat", "What a motion does after its last key.")
      .value("ONCE", Repeat::Once, "stays there")
      .value("LOOP", Repeat::Loop, "starts again")
      .value("PING_PONG", Repeat::PingPong, "runs back and forth");
  nb::class_<MotionKey>(module, "Key", "The pose of a mesh at a time.")
      .def(
          "__init__",
          [](MotionKey* self, float time, glm::vec3 translation, glm::quat rotation, bool visible) {
            new (self) MotionKey{time, translation, rotation, visible};
          },
          "time"_a, "translation"_a = glm::vec3(0), "rotation"_a = glm::quat(1, 0, 0, 0), "visible"_a = true,
          "time: seconds. translation: metres. rotation: a quaternion x, y, z, w. visible: until the next "
          "key.")
      .def_rw("time", &MotionKey::time)
      .def_rw("translation", &MotionKey::translation)
      .def_rw("rotation", &MotionKey::rotation)
      .def_rw("visible", &MotionKey::visible);
  nb::class_<MeshObject>(module, "Mesh", "Triangles of one material.")
      .def(
          "__init__",
          [](MeshObject* self, const Rows<float, 3>& positions, const Rows<uint32_t, 3>& triangles,
             uint32_t material, const std::optional<Rows<float, 3>>& normals,
             const std::optional<Rows<float, 2>>& uvs, std::string name, glm::vec3 translation,
             glm::quat rotation, glm::vec3 scale, std::vector<MotionKey> motion, Repeat repeat, bool smooth) {
            new (self) MeshObject(makeMesh(positions, triangles, material, normals, uvs, std::move(name),
                                           translation, rotation, scale, std::move(motion), repeat, smooth));
          },
          "positions"_a, "triangles"_a, "material"_a = 0, nb::kw_only(), "normals"_a.none() = nb::none(),
          "uvs"_a.none() = nb::none(), "name"_a = "", "translation"_a = glm::vec3(0),
          "rotation"_a = glm::quat(1, 0, 0, 0), "scale"_a = glm::vec3(1),
          "motion"_a = std::vector<MotionKey>(), "repeat"_a = Repeat::Once, "smooth"_a = true,
          "positions: n x 3, float32, metres. triangles: m x 3, uint32, counter-clockwise seen from the "
          "front.\n"
          "material: index into the scene's materials. normals: n x 3, float32, unit; smooth ones if None.\n"
          "uvs: n x 2, float32. rotation: a quaternion x, y, z, w. motion: keys with increasing times, which "
          "replace\n"
          "translation and rotation; smooth: whether the path has no jumps in speed.")
      .def_ro("name", &MeshObject::name);
}

}  // namespace

void addScenes(nb::module_& module) {
  addThings(module);
  addMeshes(module);
  nb::class_<Scene>(module, "Scene", "What is rendered: from `fovea.load_scene`, or made of arrays.")
      .def(nb::new_(&makeScene), nb::kw_only(), "meshes"_a, "materials"_a, "lights"_a = std::vector<Light>(),
           "cameras"_a, "camera_path"_a = std::vector<std::pair<float, Camera>>(),
           "gaze"_a = std::vector<std::pair<float, glm::vec2>>(), "exposure"_a = 1.0f,
           "environment"_a = glm::vec3(0), "full_materials"_a = false, "name"_a = "scene",
           "cameras: the first one is used. camera_path: pairs of a time in seconds and a camera. gaze: "
           "pairs of a time\n"
           "and a point in normalised image coordinates, origin top-left. exposure: displayed intensity = "
           "sRGB(exposure *\n"
           "radiance). environment: radiance of the background. full_materials: all properties of materials "
           "instead of\n"
           "diffuse ones. Raises Error with every mistake.")
      .def_ro("name", &Scene::name)
      .def_ro("cameras", &Scene::cameras)
      .def_ro("exposure", &Scene::exposure)
      .def_ro("hash", &Scene::hash, "of all content")
      .def_prop_ro("triangles", &trianglesOf, "their number")
      .def("__repr__", [](const Scene& s) {
        return "<scene " + s.name + ": " + std::to_string(trianglesOf(s)) + " triangles>";
      });
  module.def("load_scene", &loadScene, "name_or_file"_a, "environment"_a, "A scene, and warnings about it.");
  module.def("scene_names", &names, "The bare names of scenes, sorted.");
}

}  // namespace fovea::python
