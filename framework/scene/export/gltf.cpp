#include "framework/scene/export/gltf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "framework/base/text_file.h"
#include "framework/scene/export/files.h"
#include "framework/scene/export/scene_file.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;  // glTF's component types
constexpr int kVertexData = 34962, kIndexData = 34963;                    // targets of buffer views

template <class Vector>
Json numbers(const Vector& v, int count) {
  Json list = Json::array();
  for (int i = 0; i < count; ++i) list.push_back(shortest(v[i]));
  return list;
}

Json quaternion(const glm::quat& q) { return {shortest(q.x), shortest(q.y), shortest(q.z), shortest(q.w)}; }

int wrapMode(Wrap wrap) { return wrap == Wrap::Clamp ? 33071 : wrap == Wrap::Mirror ? 33648 : 10497; }

class GltfWriter {
 public:
  GltfWriter(const Scene& scene, fs::path folder, Diagnostics& warnings)
      : scene_(scene), folder_(std::move(folder)), name_(safeFileName(scene.name)), warnings_(warnings) {}

  fs::path run() {
    makeFolder(folder_);
    root_["asset"] = {{"version", "2.0"}, {"generator", "fovea"}};
    root_["scene"] = 0;
    root_["scenes"] = Json::array({Json::object()});
    materials();
    meshes();
    nodes();
    lights();
    cameras();
    skins();
    animations();
    origin();
    root_["scenes"][0]["nodes"] = roots_;
    finish();
    const std::string environment = scene_.environmentMap ? name_ + "_environment.exr" : "";
    if (scene_.environmentMap) writeEnvironment(folder_ / environment, *scene_.environmentMap);
    const SceneFileNames names{name_ + ".gltf", environment, nodeNames_, lightNames_, animationNames_};
    const fs::path file = folder_ / (name_ + ".json");
    writeText(file, sceneFileText(scene_, names, warnings_));
    return file;
  }

 private:
  void warn(const std::string& path, const std::string& message) {
    warnings_.warning({scene_.name, 0, 0}, path, message);
  }

  // ---- Buffer ----

  struct Layout {
    const char* type;
    int component, components, target;  // target 0 if none
  };

  // Returns the index of a new accessor of `count` elements.
  size_t accessor(const void* data, size_t bytes, size_t count, const Layout& layout) {
    bin_.resize((bin_.size() + 3) & ~size_t(3));
    Json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", bytes}};
    if (layout.target) view["target"] = layout.target;
    root_["bufferViews"].push_back(view);
    bin_.append(static_cast<const char*>(data), bytes);
    root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                  {"componentType", layout.component},
                                  {"count", count},
                                  {"type", layout.type}});
    return root_["accessors"].size() - 1;
  }

  template <class T>
  size_t accessor(const std::vector<T>& list, const Layout& layout) {
    return accessor(list.data(), list.size() * sizeof(T), list.size(), layout);
  }

  size_t positions(const std::vector<glm::vec3>& list) {
    const size_t index = accessor(list, {"VEC3", kFloat, 3, kVertexData});
    glm::vec3 low = list.front(), high = low;
    for (const glm::vec3& v : list) low = glm::min(low, v), high = glm::max(high, v);
    root_["accessors"][index]["min"] = numbers(low, 3);
    root_["accessors"][index]["max"] = numbers(high, 3);
    return index;
  }

  // Adds a list of single numbers, as accessors and keys need it.
  size_t scalars(const std::vector<float>& list) {
    const size_t index = accessor(list, {"SCALAR", kFloat, 1, 0});
    root_["accessors"][index]["min"] = Json::array({*std::min_element(list.begin(), list.end())});
    root_["accessors"][index]["max"] = Json::array({*std::max_element(list.begin(), list.end())});
    return index;
  }

  // ---- Materials ----

  // color: whether glTF reads the image as sRGB-encoded colours; data is linear there.
  size_t image(uint32_t texture, bool color) {
    const auto known = imageOf_.find({texture, color});
    if (known != imageOf_.end()) return known->second;
    const Texture& t = scene_.textures[texture];
    makeFolder(folder_ / "textures");
    const std::string stem = fs::path(t.name).stem().string();
    const std::string uri =
        "textures/" + imageNames_.add(safeFileName(stem.empty() ? "texture" : stem)) + ".png";
    image::Image pixels = texelImage(t, 4);
    if (color != t.srgb) {
      if (color)
        warn("textures", "texture `" + t.name + "` is linear: encoded as sRGB, its darks get coarser");
      for (size_t i = 0; i < pixels.data.size(); ++i)
        if (i % 4 != 3)
          pixels.data[i] = color ? image::srgbEncode(pixels.data[i]) : image::srgbDecode(pixels.data[i]);
    }
    image::write(folder_ / uri, {{"", std::move(pixels)}});
    root_["images"].push_back({{"uri", uri}});
    return imageOf_[{texture, color}] = root_["images"].size() - 1;
  }

  size_t sampler(const TextureUse& use) {
    const int filter = use.nearest ? 9728 : 9729;
    const Json wanted = {{"magFilter", filter},
                         {"minFilter", filter},
                         {"wrapS", wrapMode(use.wrapU)},
                         {"wrapT", wrapMode(use.wrapV)}};
    return indexOf("samplers", wanted);
  }

  // Index of an equal entry, or of a new one.
  size_t indexOf(const char* list, const Json& wanted) {
    Json& entries = root_[list];
    for (size_t i = 0; i < entries.size(); ++i)
      if (entries[i] == wanted) return i;
    entries.push_back(wanted);
    return entries.size() - 1;
  }

  // KHR_texture_transform, the inverse of what the loader builds: columns (c sx, -s sx), (s sy, c sy), offset.
  Json textureUse(const TextureUse& use, const std::string& material, bool color) {
    const size_t source = image(use.texture, color);
    Json out = {{"index", indexOf("textures", {{"source", source}, {"sampler", sampler(use)}})}};
    if (use.set != 0) out["texCoord"] = use.set;
    const glm::mat3x2& m = use.transform;
    if (m == glm::mat3x2{1, 0, 0, 1, 0, 0}) return out;
    const float angle = std::atan2(-m[0].y, m[0].x), c = std::cos(angle), s = std::sin(angle);
    const glm::vec2 scale(glm::length(m[0]), s * m[1].x + c * m[1].y);
    if (glm::length(m[1] - scale.y * glm::vec2(s, c)) > 1e-4f * glm::length(m[1]))
      warn("materials", "the texture transform of `" + material + "` shears; glTF cannot say so");
    Json transform = Json::object();
    transform["offset"] = numbers(m[2], 2);
    if (angle != 0) transform["rotation"] = shortest(angle);
    transform["scale"] = numbers(scale, 2);
    out["extensions"]["KHR_texture_transform"] = transform;
    extensions_.insert("KHR_texture_transform");
    return out;
  }

  void materials() {
    for (const Material& m : scene_.materials) {
      Json out = {{"name", m.name}, {"pbrMetallicRoughness", metallicRoughness(m)}};
      put(out, "normalTexture", m.normalTexture, m, false);
      if (out.contains("normalTexture") && m.normalScale != 1)
        out["normalTexture"]["scale"] = shortest(m.normalScale);
      if (m.emission != glm::vec3(0)) {
        // Factors are at most 1; the strength carries the rest.
        const double strength =
            std::max({1.0, double(m.emission.x), double(m.emission.y), double(m.emission.z)});
        out["emissiveFactor"] =
            Json{m.emission.x / strength, m.emission.y / strength, m.emission.z / strength};
        put(out, "emissiveTexture", m.emissionTexture, m, true);
        if (strength > 1) extension(out, "KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
      }
      extensions(m, out);
      if (m.blended) {
        out["alphaMode"] = "BLEND";
      } else if (m.masked) {
        out["alphaMode"] = "MASK";
        out["alphaCutoff"] = shortest(m.alphaCutoff);
      }
      if (m.doubleSided) out["doubleSided"] = true;
      root_["materials"].push_back(out);
    }
  }

  // Adds a texture if the material has it.
  void put(Json& to, const char* key, const TextureUse& use, const Material& m, bool color) {
    if (use && use.texture < scene_.textures.size()) to[key] = textureUse(use, m.name, color);
  }

  void extension(Json& material, const char* name, Json members) {
    material["extensions"][name] = std::move(members);
    extensions_.insert(name);
  }

  Json metallicRoughness(const Material& m) {
    Json pbr = {{"baseColorFactor", numbers(m.baseColor, 4)}};
    const bool textured =
        m.metallicRoughnessTexture && m.metallicRoughnessTexture.texture < scene_.textures.size();
    // The loader takes a material that says nothing of metal for a metal only where materials are full.
    if (textured || m.metallic != 1 || m.metallicMean != 0)
      pbr["metallicFactor"] = shortest(textured ? m.metallic : m.meanMetallic());
    pbr["roughnessFactor"] = shortest(m.roughness);
    put(pbr, "baseColorTexture", m.baseColorTexture, m, true);
    put(pbr, "metallicRoughnessTexture", m.metallicRoughnessTexture, m, false);
    return pbr;
  }

  void extensions(const Material& m, Json& out) {
    if (m.ior != 1.5f) extension(out, "KHR_materials_ior", {{"ior", shortest(m.ior)}});
    if (m.specular != 1 || m.specularColor != glm::vec3(1) || m.specularTexture || m.specularColorTexture) {
      Json e = {{"specularFactor", shortest(m.specular)},
                {"specularColorFactor", numbers(m.specularColor, 3)}};
      put(e, "specularTexture", m.specularTexture, m, false);
      put(e, "specularColorTexture", m.specularColorTexture, m, true);
      extension(out, "KHR_materials_specular", e);
    }
    if (m.transmission > 0) {
      Json e = {{"transmissionFactor", shortest(m.transmission)}};
      put(e, "transmissionTexture", m.transmissionTexture, m, false);
      extension(out, "KHR_materials_transmission", e);
    }
    if (m.clearcoat > 0) {
      Json e = {{"clearcoatFactor", shortest(m.clearcoat)},
                {"clearcoatRoughnessFactor", shortest(m.clearcoatRoughness)}};
      put(e, "clearcoatTexture", m.clearcoatTexture, m, false);
      put(e, "clearcoatRoughnessTexture", m.clearcoatRoughnessTexture, m, false);
      extension(out, "KHR_materials_clearcoat", e);
    }
    if (m.unlit) extension(out, "KHR_materials_unlit", Json::object());
  }

  // ---- Meshes ----

  Json primitive(const Primitive& p, const std::vector<MorphTarget>& targets) {
    Json attributes = {{"POSITION", positions(p.positions)},
                       {"NORMAL", accessor(p.normals, {"VEC3", kFloat, 3, kVertexData})},
                       {"TEXCOORD_0", accessor(p.uvs, {"VEC2", kFloat, 2, kVertexData})}};
    if (!p.secondUvs.empty())
      attributes["TEXCOORD_1"] = accessor(p.secondUvs, {"VEC2", kFloat, 2, kVertexData});
    if (!p.colors.empty()) attributes["COLOR_0"] = accessor(p.colors, {"VEC4", kFloat, 4, kVertexData});
    if (!p.tangents.empty()) attributes["TANGENT"] = accessor(p.tangents, {"VEC4", kFloat, 4, kVertexData});
    const size_t vertices = p.positions.size();
    for (size_t set = 0; vertices > 0 && set < p.joints.size() / vertices; ++set) {
      const auto part = [&](const auto& list) {
        const auto begin = list.begin() + std::ptrdiff_t(set * vertices);
        return std::decay_t<decltype(list)>(begin, begin + std::ptrdiff_t(vertices));
      };
      const std::string number = std::to_string(set);
      attributes["JOINTS_" + number] = accessor(part(p.joints), {"VEC4", kUnsignedShort, 4, kVertexData});
      attributes["WEIGHTS_" + number] = accessor(part(p.weights), {"VEC4", kFloat, 4, kVertexData});
    }
    Json out = {{"attributes", attributes},
                {"indices", accessor(p.indices, {"SCALAR", kUnsignedInt, 1, kIndexData})},
                {"material", p.material}};
    for (const MorphTarget& t : targets) {
      Json target = Json::object();
      if (!t.positions.empty()) target["POSITION"] = positions(t.positions);
      if (!t.normals.empty()) target["NORMAL"] = accessor(t.normals, {"VEC3", kFloat, 3, kVertexData});
      out["targets"].push_back(target);
    }
    return out;
  }

  // Morph targets of a cage, applied to its refined triangles. Limit points are linear in the points of the cage, so
  // positions are exact; normals are exact at the ends of each target.
  std::vector<std::vector<MorphTarget>> refinedTargets(const Mesh& mesh) {
    std::vector<std::vector<MorphTarget>> all(mesh.primitives.size());
    const SubdivisionCage& cage = *mesh.cage;
    if (!cage.joints.empty())
      warn("meshes", "mesh `" + mesh.name + "` is a cage that follows joints: exported at rest");
    if (cage.targets.empty()) return all;
    const Stencils stencils(cage);
    for (const MorphTarget& target : cage.targets) {
      std::vector<glm::vec3> points = cage.positions, limits(stencils.vertexCount()), normals(limits.size());
      for (size_t i = 0; i < std::min(points.size(), target.positions.size()); ++i)
        points[i] += target.positions[i];
      stencils.evaluate(points, limits, normals);
      size_t v = 0;
      for (size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& p = mesh.primitives[i];
        MorphTarget& out = all[i].emplace_back();
        for (size_t k = 0; k < p.positions.size(); ++k, ++v) {
          out.positions.push_back(limits[v] - p.positions[k]);
          out.normals.push_back(normals[v] - p.normals[k]);
        }
      }
    }
    return all;
  }

  void meshes() {
    meshOf_.assign(scene_.meshes.size(), kNoIndex);
    for (size_t i = 0; i < scene_.meshes.size(); ++i) {
      const Mesh& mesh = scene_.meshes[i];
      Json out = {{"name", mesh.name}, {"primitives", Json::array()}};
      std::vector<std::vector<MorphTarget>> refined;
      if (mesh.cage) refined = refinedTargets(mesh);
      for (size_t k = 0; k < mesh.primitives.size(); ++k) {
        const Primitive& p = mesh.primitives[k];
        if (!p.indices.empty()) out["primitives"].push_back(primitive(p, mesh.cage ? refined[k] : p.targets));
      }
      if (!mesh.weights.empty()) out["weights"] = mesh.weights;
      if (out["primitives"].empty()) continue;  // glTF has no empty meshes
      meshOf_[i] = uint32_t(root_["meshes"].size());
      root_["meshes"].push_back(std::move(out));
    }
  }

  // ---- Nodes ----

  void nodes() {
    std::vector<Json> list;
    for (const Node& n : scene_.nodes) {
      nodeNames_.push_back(names_.add(n.name));
      Json out = {{"name", nodeNames_.back()}};
      if (n.matrix) {
        Json matrix = Json::array();
        for (int i = 0; i < 16; ++i) matrix.push_back(shortest((*n.matrix)[i / 4][i % 4]));
        out["matrix"] = matrix;
      } else {
        out["translation"] = numbers(n.translation, 3);
        out["rotation"] = quaternion(n.rotation);
        out["scale"] = numbers(n.scale, 3);
      }
      if (n.mesh != kNoIndex && meshOf_[n.mesh] != kNoIndex) {
        out["mesh"] = meshOf_[n.mesh];
        if (n.skin != kNoIndex) out["skin"] = n.skin;
        if (!n.weights.empty()) out["weights"] = n.weights;
      }
      const size_t index = list.size();
      (n.parent == kNoIndex ? roots_ : list[n.parent]["children"]).push_back(index);
      list.push_back(std::move(out));
    }
    for (Json& n : list) root_["nodes"].push_back(std::move(n));
  }

  // A separate root, because the lights and cameras of a scene are in world space.
  void addRoot(Json node) {
    roots_.push_back(root_["nodes"].size());
    root_["nodes"].push_back(std::move(node));
  }

  // Everything in the scene is relative to its origin, which has too many digits for single precision.
  void origin() {
    const glm::dvec3& o = scene_.origin;
    if (o == glm::dvec3(0)) return;
    const Json node = {
        {"name", names_.add("origin")}, {"translation", {o.x, o.y, o.z}}, {"children", roots_}};
    roots_ = Json::array({root_["nodes"].size()});
    root_["nodes"].push_back(node);
  }

  void lights() {
    static const char* const kTypes[] = {"directional", "point", "spot"};
    Json list = Json::array();
    for (const Light& l : scene_.lights) {
      lightNames_.push_back(lightUnique_.add(l.name));
      Json out = {{"name", lightNames_.back()},
                  {"type", kTypes[uint32_t(l.type)]},
                  {"color", numbers(l.color, 3)},
                  {"intensity", shortest(l.intensity)}};
      if (l.range > 0 && l.type != LightType::Directional) out["range"] = shortest(l.range);
      if (l.type == LightType::Spot)
        out["spot"] = {{"innerConeAngle", shortest(l.innerConeAngle)},
                       {"outerConeAngle", shortest(l.outerConeAngle)}};
      addRoot({{"name", names_.add("light " + lightNames_.back())},
               {"translation", numbers(l.position, 3)},
               {"rotation", quaternion(lookAlong(l.direction, {0, 1, 0}))},
               {"extensions", {{"KHR_lights_punctual", {{"light", list.size()}}}}}});
      list.push_back(std::move(out));
    }
    if (list.empty()) return;
    root_["extensions"]["KHR_lights_punctual"]["lights"] = list;
    extensions_.insert("KHR_lights_punctual");
  }

  void cameras() {
    for (const Camera& c : scene_.cameras) {
      Json lens = {{"yfov", shortest(c.verticalFov)}, {"znear", shortest(c.zNear)}};
      if (c.zFar > 0) lens["zfar"] = shortest(c.zFar);
      if (c.aspectRatio > 0) lens["aspectRatio"] = shortest(c.aspectRatio);
      root_["cameras"].push_back({{"name", c.name}, {"type", "perspective"}, {"perspective", lens}});
      addRoot({{"name", names_.add("camera " + c.name)},
               {"translation", numbers(c.position, 3)},
               {"rotation", quaternion(c.orientation)},
               {"camera", root_["cameras"].size() - 1}});
    }
  }

  // ---- What deforms ----

  void skins() {
    for (const Skin& skin : scene_.skins)
      root_["skins"].push_back({{"name", skin.name},
                                {"inverseBindMatrices", accessor(skin.inverseBind, {"MAT4", kFloat, 16, 0})},
                                {"joints", skin.joints}});
  }

  void animations() {
    static const char* const kPaths[] = {"translation", "rotation", "scale", "weights"};
    static const char* const kInterpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    for (const Animation& a : scene_.animations) {
      animationNames_.push_back(animationUnique_.add(a.name));
      Json out = {{"name", animationNames_.back()}, {"channels", Json::array()}, {"samplers", Json::array()}};
      for (const AnimationChannel& c : a.channels) {
        const bool rotation = c.path == AnimationChannel::Path::Rotation,
                   weights = c.path == AnimationChannel::Path::Weights;
        const Layout layout = {weights    ? "SCALAR"
                               : rotation ? "VEC4"
                                          : "VEC3",
                               kFloat,
                               weights    ? 1
                               : rotation ? 4
                                          : 3,
                               0};
        const size_t input = scalars(c.times);
        const size_t output = accessor(c.values.data(), c.values.size() * sizeof(float),
                                       c.values.size() / size_t(layout.components), layout);
        out["channels"].push_back({{"sampler", out["samplers"].size()},
                                   {"target", {{"node", c.node}, {"path", kPaths[size_t(c.path)]}}}});
        out["samplers"].push_back({{"input", input},
                                   {"output", output},
                                   {"interpolation", kInterpolations[size_t(c.interpolation)]}});
      }
      if (a.channels.empty())
        animationNames_.back().clear();  // glTF has none without channels
      else
        root_["animations"].push_back(std::move(out));
    }
  }

  void finish() {
    if (bin_.size() > size_t(1) << 31)
      throw Error(ExitCode::BadInput, "scene `" + scene_.name + "`: its meshes need more than 2 GiB",
                  "simplify the model");
    for (const std::string& e : extensions_) root_["extensionsUsed"].push_back(e);
    if (!bin_.empty()) {
      root_["buffers"].push_back({{"uri", name_ + ".bin"}, {"byteLength", bin_.size()}});
      writeText(folder_ / (name_ + ".bin"), bin_);
    }
    writeText(folder_ / (name_ + ".gltf"), root_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  }

  const Scene& scene_;
  fs::path folder_;
  std::string name_;
  Diagnostics& warnings_;
  Json root_, roots_ = Json::array();
  std::string bin_;
  std::map<std::pair<uint32_t, bool>, size_t> imageOf_;  // by texture and whether it holds colours
  std::vector<uint32_t> meshOf_;
  std::set<std::string> extensions_;
  UniqueNames names_, lightUnique_, animationUnique_, imageNames_{"_"};
  std::vector<std::string> nodeNames_, lightNames_, animationNames_;
};

}  // namespace

fs::path exportGltf(const Scene& scene, const fs::path& folder, Diagnostics& warnings) {
  return GltfWriter(scene, folder, warnings).run();
}

}  // namespace fovea::scene
