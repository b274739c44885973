// Builds meshes: converts attributes to triangles, with the morph targets and joints that move their vertices.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <set>

#include "framework/base/budget.h"
#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

const std::string kIgnored = "it is ignored";
constexpr uint64_t kBytesOfVertex = 64;  // position, normal, texture coordinates, and as much for indices

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Zero if the triangle has no area. In double precision, so that thin slivers of large models count as triangles.
glm::dvec3 areaVector(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
}

// Converts strips and fans to triangles and keeps the winding (glTF 2.0, 3.7.2.1).
std::vector<uint32_t> toTriangles(const std::vector<uint32_t>& in, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return {in.begin(), in.end() - long(in.size() % 3)};
  std::vector<uint32_t> out;
  for (size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    else
      out.insert(out.end(), {in[0], in[i + 1], in[i + 2]});
  }
  return out;
}

class MeshBuilder {
 public:
  explicit MeshBuilder(Context& c) : c_(c) {}

  Mesh build(size_t index) {
    const tinygltf::Mesh& from = c_.model.meshes[index];
    mesh_ = nameOf("meshes", index, from.name);
    Mesh mesh;
    mesh.name = from.name.empty() ? "mesh " + std::to_string(index) : from.name;
    const json::Value* written = c_.root.find("meshes")->items[index].find("primitives");
    if (written->items.size() != from.primitives.size())
      c_.fail(mesh_, "a primitive could not be understood", "check the types of its attributes");
    isCage_ = hasCage(*written);
    for (size_t i = 0; i < from.primitives.size(); ++i) {
      Primitive p;
      if (!primitive(from.primitives[i], mesh_ + ".primitives[" + std::to_string(i) + "]", p)) continue;
      mesh.primitives.push_back(std::move(p));
    }
    readWeights(from, mesh);
    if (isCage_) buildCage(*written, mesh_, mesh);
    return mesh;
  }

 private:
  std::string accessorPath(const std::string& place, const std::string& attribute, int accessor) const {
    return place + "." + attribute + ", accessors[" + std::to_string(accessor) + "]";
  }

  size_t countOf(int accessor) const { return c_.model.accessors[size_t(accessor)].count; }

  // For attributes without which a mesh can be shown.
  void checkCount(int accessor, size_t count, const std::string& path) const {
    if (countOf(accessor) != count)
      c_.fail(path, "has " + std::to_string(countOf(accessor)) + " elements, POSITION has " +
                        std::to_string(count));
  }

  bool primitive(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    if (from.mode != TINYGLTF_MODE_TRIANGLES && from.mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
        from.mode != TINYGLTF_MODE_TRIANGLE_FAN) {
      c_.warn(place, "points and lines are not drawn: the primitive is left out");
      return false;
    }
    const auto position = from.attributes.find("POSITION");
    if (position == from.attributes.end()) {
      c_.warn(place, "without POSITION there is nothing to draw: the primitive is left out");
      return false;
    }
    out.material = materialOf(from.material);
    readPositions(position->second, place, out);
    readTextureCoordinates(from, place, out);
    std::vector<uint32_t> indices = indicesOf(from, place, out.positions.size());
    out.indices = toTriangles(indices, from.mode);
    if (!isCage_) dropDegenerate(out);
    readSkin(from, place, out);
    readTargets(from, place, out);
    readColors(from, place, out);
    if (!isCage_) {  // last, because flat shading gives triangles vertices of their own
      readNormals(from, place, out);
      readTangents(from, place, out);
    }
    if (isCage_ && (!out.colors.empty() || !out.secondUvs.empty()))
      c_.warn(place, "a cage keeps neither vertex colours nor a second set of texture coordinates");
    c_.vertices += out.positions.size();
    checkSize(place);
    return !out.indices.empty();
  }

  void checkSize(const std::string& place) const {
    if (c_.vertices > kMaxVertices)
      c_.fail(place, "the meshes have more than " + std::to_string(kMaxVertices) + " vertices in all",
              "simplify the model");
  }

  uint32_t materialOf(int material) {
    if (material >= 0) return uint32_t(material);
    if (c_.defaultMaterial == kNoIndex) {
      // glTF's default material is a white rough metal, which would be black as a diffuse material.
      c_.defaultMaterial = uint32_t(c_.scene.materials.size());
      Material m;
      m.name = "default";
      m.baseColor = {0.8f, 0.8f, 0.8f, 1.0f};
      c_.scene.materials.push_back(m);
    }
    return c_.defaultMaterial;
  }

  void readPositions(int accessor, const std::string& place, Primitive& out) {
    const std::string path = accessorPath(place, "POSITION", accessor);
    c_.vertices += countOf(accessor);
    checkSize(place);
    c_.vertices -= countOf(accessor);
    claimContent(countOf(accessor) * kBytesOfVertex, c_.source.name + ": " + place);
    const std::vector<float> v = readFloats(c_, accessor, 3, path);
    out.positions.resize(v.size() / 3);
    for (size_t i = 0; i < out.positions.size(); ++i) {
      out.positions[i] = glm::make_vec3(&v[3 * i]);
      if (!isFinite(out.positions[i]))
        c_.fail(path, "vertex " + std::to_string(i) + " has a position that is not finite (NaN or infinity)",
                "repair the mesh in a modelling program, then export it again");
    }
  }

  void readTextureCoordinates(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    std::array<int, 2> sets = {0, -1};
    if (from.material >= 0) sets = c_.texCoordsOfMaterial[size_t(from.material)];
    out.uvs = uvsOf(from, place, sets[0], out.positions.size());
    if (sets[1] >= 0) out.secondUvs = uvsOf(from, place, sets[1], out.positions.size());
    const Material* material = from.material >= 0 ? &c_.scene.materials[size_t(from.material)] : nullptr;
    if (!material || !std::any_of(std::begin(kMaterialTextures), std::end(kMaterialTextures),
                                  [&](auto use) { return bool(material->*use); }))
      return;
    for (const int set : sets)
      if (set >= 0 && !from.attributes.contains("TEXCOORD_" + std::to_string(set)))
        c_.warn(place, "has no TEXCOORD_" + std::to_string(set) + ", which material `" + material->name +
                           "` reads: one point of the texture covers it");
  }

  std::vector<glm::vec2> uvsOf(const tinygltf::Primitive& from, const std::string& place, int set,
                               size_t count) {
    std::vector<glm::vec2> uvs(count, glm::vec2(0.0f));
    const std::string name = "TEXCOORD_" + std::to_string(set);
    const auto found = from.attributes.find(name);
    if (found == from.attributes.end()) return uvs;
    const std::string path = accessorPath(place, name, found->second);
    const auto read = [&] {
      checkCount(found->second, count, path);
      const std::vector<float> v = readFloats(c_, found->second, 2, path);
      for (size_t i = 0; i < count; ++i) {
        const glm::vec2 uv = glm::make_vec2(&v[2 * i]);
        uvs[i] = std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0.0f);
      }
    };
    c_.attempt(read, "it is ignored, and one point of textures covers the primitive");
    return uvs;
  }

  // Linear RGB or RGBA. What is not finite reads as 1.
  void readColors(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    const auto found = from.attributes.find("COLOR_0");
    if (found == from.attributes.end()) return;
    const std::string path = accessorPath(place, "COLOR_0", found->second);
    const auto read = [&] {
      checkCount(found->second, out.positions.size(), path);
      const size_t components = c_.model.accessors[size_t(found->second)].type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
      const std::vector<float> v = readFloats(c_, found->second, int(components), path);
      out.colors.assign(out.positions.size(), glm::vec4(1.0f));
      for (size_t i = 0; i < v.size(); ++i)
        if (std::isfinite(v[i])) out.colors[i / components][int(i % components)] = std::max(v[i], 0.0f);
      colored_.insert(mesh_);
    };
    c_.attempt(read, kIgnored);
  }

  // Only where a normal map needs them, and only beside normals of the model (glTF 2.0, 3.7.2.1).
  void readTangents(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    const auto found = from.attributes.find("TANGENT");
    if (found == from.attributes.end() || !from.attributes.contains("NORMAL")) return;
    if (from.material < 0 || !c_.scene.materials[size_t(from.material)].normalTexture) return;
    const std::string path = accessorPath(place, "TANGENT", found->second);
    const auto read = [&] {
      checkCount(found->second, out.positions.size(), path);
      const std::vector<float> v = readFloats(c_, found->second, 4, path);
      for (size_t i = 0; i < out.positions.size(); ++i) out.tangents.push_back(glm::make_vec4(&v[4 * i]));
    };
    c_.attempt(read, kIgnored);
  }

  // All sets of four joints per vertex.
  void readSkin(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    const auto read = [&] {
      for (int set = 0;; ++set) {
        const auto joints = from.attributes.find("JOINTS_" + std::to_string(set)),
                   weights = from.attributes.find("WEIGHTS_" + std::to_string(set));
        if (joints == from.attributes.end() || weights == from.attributes.end()) return;
        readJoints({joints->first, joints->second}, {weights->first, weights->second}, place, out);
      }
    };
    if (!c_.attempt(read, "the primitive is shown unskinned")) {
      out.joints.clear();
      out.weights.clear();
    }
    if (!out.joints.empty()) normalizeWeights(place, out);
  }

  using NamedAccessor = std::pair<std::string, int>;
  void readJoints(const NamedAccessor& joints, const NamedAccessor& weights, const std::string& place,
                  Primitive& out) {
    const size_t count = out.positions.size();
    const std::string path = accessorPath(place, joints.first, joints.second);
    const std::string weightPath = accessorPath(place, weights.first, weights.second);
    checkCount(joints.second, count, path);
    checkCount(weights.second, count, weightPath);
    const std::vector<float> j = readFloats(c_, joints.second, 4, path);
    const std::vector<float> w = readFloats(c_, weights.second, 4, weightPath);
    for (size_t i = 0; i < count; ++i) {
      const glm::vec4 weight = glm::make_vec4(&w[4 * i]);
      glm::u16vec4 joint(0);
      glm::vec4 kept(0);
      for (int k = 0; k < 4; ++k) {
        if (!(weight[k] > 0.0f) || !std::isfinite(weight[k])) continue;  // its joint does not matter
        kept[k] = weight[k];
        joint[k] = uint16_t(std::clamp(j[4 * i + size_t(k)], 0.0f, 65535.0f));
      }
      out.joints.push_back(joint);
      out.weights.push_back(kept);
    }
  }

  // The weights of a vertex get the sum 1; without any, it follows the first joint. Sets without weights are left out,
  // and of a cage, which has one set, all joints but the four with the largest weights.
  void normalizeWeights(const std::string& place, Primitive& out) {
    const size_t count = out.positions.size();
    const auto weighs = [](glm::vec4 w) { return w != glm::vec4(0.0f); };
    while (out.weights.size() > count &&
           std::none_of(out.weights.end() - long(count), out.weights.end(), weighs)) {
      out.weights.resize(out.weights.size() - count);
      out.joints.resize(out.weights.size());
    }
    if (isCage_ && out.joints.size() > count) keepHeaviest(place, out);
    for (size_t i = 0; i < count; ++i) {
      float sum = 0;
      for (size_t e = i; e < out.weights.size(); e += count) sum += glm::dot(out.weights[e], glm::vec4(1.0f));
      for (size_t e = i; e < out.weights.size(); e += count) out.weights[e] /= sum > 0.0f ? sum : 1.0f;
      if (!(sum > 0.0f)) out.weights[i] = {1, 0, 0, 0};
    }
  }

  void keepHeaviest(const std::string& place, Primitive& out) {
    c_.warn(place,
            "the points of a cage follow at most four joints: those with the largest weights are kept");
    const size_t count = out.positions.size();
    for (size_t i = 0; i < count; ++i) {
      std::vector<std::pair<float, uint16_t>> all;
      for (size_t e = i; e < out.weights.size(); e += count)
        for (int k = 0; k < 4; ++k) all.emplace_back(out.weights[e][k], out.joints[e][k]);
      std::stable_sort(all.begin(), all.end(),
                       [](const auto& a, const auto& b) { return a.first > b.first; });
      for (int k = 0; k < 4; ++k) {
        out.weights[i][k] = all[size_t(k)].first;
        out.joints[i][k] = all[size_t(k)].second;
      }
    }
    out.weights.resize(count);
    out.joints.resize(count);
  }

  std::vector<glm::vec3> displacements(const std::map<std::string, int>& target, const char* attribute,
                                       const std::string& place, size_t count) {
    std::vector<glm::vec3> list;
    const auto found = target.find(attribute);
    if (found == target.end()) return list;
    const std::string path = accessorPath(place, attribute, found->second);
    c_.vertices += count;
    checkSize(place);
    const auto read = [&] {
      checkCount(found->second, count, path);
      const std::vector<float> v = readFloats(c_, found->second, 3, path);
      for (size_t i = 0; i < count; ++i) {
        list.push_back(glm::make_vec3(&v[3 * i]));
        if (!isFinite(list[i]))
          c_.fail(path, "vertex " + std::to_string(i) + " is displaced by what is not finite");
      }
    };
    if (!c_.attempt(read, "the displacements are ignored")) list.clear();
    return list;
  }

  void readTargets(const tinygltf::Primitive& from, const std::string& place, Primitive& out) {
    for (size_t t = 0; t < from.targets.size(); ++t) {
      const std::string path = place + ".targets[" + std::to_string(t) + "]";
      out.targets.push_back({displacements(from.targets[t], "POSITION", path, out.positions.size()),
                             displacements(from.targets[t], "NORMAL", path, out.positions.size())});
    }
  }

  void readWeights(const tinygltf::Mesh& from, Mesh& mesh) {
    size_t targets = 0;
    for (const Primitive& p : mesh.primitives) targets = std::max(targets, p.targets.size());
    const auto differs = [&](const Primitive& p) { return p.targets.size() != targets; };
    if (std::ranges::any_of(mesh.primitives, differs)) {
      c_.warn(mesh_, "its primitives have different numbers of morph targets; missing ones displace nothing");
      for (Primitive& p : mesh.primitives) p.targets.resize(targets);
    }
    if (!from.weights.empty() && from.weights.size() != targets && !mesh.primitives.empty())
      return c_.warn(mesh_ + ".weights", std::to_string(from.weights.size()) + " weights for " +
                                             std::to_string(targets) + " morph targets: they are ignored");
    for (size_t i = 0; i < std::min(targets, from.weights.size()); ++i)
      mesh.weights.push_back(float(from.weights[i]));
  }

  std::vector<uint32_t> indicesOf(const tinygltf::Primitive& from, const std::string& place, size_t count) {
    std::vector<uint32_t> indices;
    if (from.indices < 0) {
      indices.resize(count);
      for (size_t i = 0; i < count; ++i) indices[i] = uint32_t(i);
      return indices;
    }
    const std::string path = accessorPath(place, "indices", from.indices);
    if (countOf(from.indices) > 3 * kMaxVertices)
      c_.fail(path, "more than " + std::to_string(3 * kMaxVertices) + " indices", "simplify the model");
    indices = readIndices(c_, from.indices, path);
    for (size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= count)
        c_.fail(path, "index number " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                          ", but there are only " + std::to_string(count) + " vertices");
    return indices;
  }

  void dropDegenerate(Primitive& p) {
    std::vector<uint32_t>& ix = p.indices;
    size_t kept = 0;
    for (size_t i = 0; i + 2 < ix.size(); i += 3) {
      const glm::dvec3 area = areaVector(p.positions[ix[i]], p.positions[ix[i + 1]], p.positions[ix[i + 2]]);
      if (area == glm::dvec3(0.0)) {
        ++c_.degenerateTriangles;
        continue;
      }
      for (size_t k = 0; k < 3; ++k) ix[kept + k] = ix[i + k];
      kept += 3;
    }
    ix.resize(kept);
  }

  void readNormals(const tinygltf::Primitive& from, const std::string& place, Primitive& p) {
    const auto found = from.attributes.find("NORMAL");
    if (found == from.attributes.end()) return flatNormals(p);
    const std::string path = accessorPath(place, "NORMAL", found->second);
    std::vector<float> v;
    const auto read = [&] {
      checkCount(found->second, p.positions.size(), path);
      v = readFloats(c_, found->second, 3, path);
    };
    if (!c_.attempt(read, "it is ignored, and the primitive is flat-shaded")) return flatNormals(p);
    p.normals.resize(p.positions.size());
    std::vector<bool> bad(p.positions.size());
    for (size_t i = 0; i < p.normals.size(); ++i) {
      const glm::vec3 n = glm::make_vec3(&v[3 * i]);
      const float length = glm::length(n);
      bad[i] = !(length > 1e-6f && std::isfinite(length));
      p.normals[i] = bad[i] ? glm::vec3(0, 1, 0) : n / length;
    }
    // A vertex without a usable normal takes that of the first triangle to which it belongs.
    for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
      const uint32_t* t = &p.indices[i];
      for (int k = 0; k < 3; ++k) {
        if (!bad[t[k]]) continue;
        bad[t[k]] = false;
        ++c_.badNormals;
        p.normals[t[k]] =
            glm::vec3(glm::normalize(areaVector(p.positions[t[0]], p.positions[t[1]], p.positions[t[2]])));
      }
    }
  }

  // Without normals a mesh is flat-shaded (glTF 2.0, 3.7.2.1): every triangle gets vertices of its own.
  void flatNormals(Primitive& p) {
    c_.vertices += p.indices.size();
    checkSize(mesh_);
    c_.vertices -= p.indices.size();
    const size_t count = p.positions.size();
    std::vector<uint32_t> vertices = std::move(p.indices);
    const auto spread = [&](auto& list) {
      auto all = std::move(list);
      list.clear();
      if (all.empty()) return;
      list.reserve(all.size() / count * vertices.size());
      for (size_t set = 0; set < all.size(); set += count)
        for (uint32_t v : vertices) list.push_back(all[set + v]);
    };
    p.normals.clear();
    p.indices.clear();
    for (size_t i = 0; i + 2 < vertices.size(); i += 3) {
      const uint32_t* t = &vertices[i];
      const glm::vec3 n(glm::normalize(areaVector(p.positions[t[0]], p.positions[t[1]], p.positions[t[2]])));
      p.normals.insert(p.normals.end(), 3, n);
      for (uint32_t k = 0; k < 3; ++k) p.indices.push_back(uint32_t(i) + k);
    }
    spread(p.positions);
    spread(p.uvs);
    spread(p.secondUvs);
    spread(p.colors);
    spread(p.joints);
    spread(p.weights);
    for (MorphTarget& t : p.targets) {
      spread(t.positions);
      spread(t.normals);
    }
  }

 public:
  std::set<std::string> colored_;

 private:
  Context& c_;
  std::string mesh_;
  bool isCage_ = false;  // faces and vertices stay as they are
};

}  // namespace

void buildMeshes(Context& c) {
  MeshBuilder builder(c);
  for (size_t i = 0; i < c.model.meshes.size(); ++i) c.scene.meshes.push_back(builder.build(i));
  refineCages(c);
  if (c.degenerateTriangles > 0)
    c.warn("meshes", std::to_string(c.degenerateTriangles) + " triangles without area were left out");
  if (c.badNormals > 0)
    c.warn("meshes", std::to_string(c.badNormals) +
                         " normals were zero or not finite; they now follow their triangles");
  if (!builder.colored_.empty())
    c.warnIfDiffuse(*builder.colored_.begin(),
                    "diffuse materials ignore the vertex colours (COLOR_0), apart from their alpha, of " +
                        std::to_string(builder.colored_.size()) + " mesh(es)");
}

}  // namespace fovea::scene::gltf
