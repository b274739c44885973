// Sheets, normals and the builders of the modelling toolkit.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <unordered_map>
#include <utility>

#include "framework/base/random.h"
#include "framework/scene/file/scene_file.h"
#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {
namespace {

struct PositionHash {
  size_t operator()(const glm::vec3& p) const {
    uint32_t bits[3];
    const glm::vec3 q = p + 0.0f;  // -0 is 0
    std::memcpy(bits, &q, sizeof bits);
    return hashPcg(bits[0] ^ hashPcg(bits[1] ^ hashPcg(bits[2])));
  }
};

// Corners of triangles (indices into Shape::indices) by position.
struct Corners {
  std::vector<uint32_t> first, list, placeOf;  // of place p: list[first[p] .. first[p + 1])
};

Corners cornersOf(const Shape& s) {
  std::unordered_map<glm::vec3, uint32_t, PositionHash> places;
  places.reserve(s.positions.size());
  Corners c;
  std::vector<uint32_t> placeOfVertex(s.positions.size());
  for (size_t v = 0; v < s.positions.size(); ++v)
    placeOfVertex[v] = places.try_emplace(s.positions[v], uint32_t(places.size())).first->second;
  c.first.assign(places.size() + 1, 0);
  for (uint32_t v : s.indices) ++c.first[placeOfVertex[v] + 1];
  for (size_t p = 0; p < places.size(); ++p) c.first[p + 1] += c.first[p];
  c.list.resize(s.indices.size());
  c.placeOf.resize(s.indices.size());
  std::vector<uint32_t> next(c.first.begin(), c.first.end() - 1);
  for (uint32_t k = 0; k < s.indices.size(); ++k) {
    c.placeOf[k] = placeOfVertex[s.indices[k]];
    c.list[next[c.placeOf[k]]++] = k;
  }
  return c;
}

}  // namespace

Sheet sheet(uint32_t columns, uint32_t rows, glm::vec2 size,
            const std::function<glm::vec3(float u, float v)>& f) {
  Sheet s{columns, rows, {}, {}};
  for (uint32_t j = 0; j <= rows; ++j)
    for (uint32_t i = 0; i <= columns; ++i) {
      const glm::vec2 t(float(i) / float(columns), float(j) / float(rows));
      s.positions.push_back(f(t.x, t.y));
      s.uvs.push_back(t * size);
    }
  return s;
}

Shape surface(const Sheet& sheet, float thickness) {
  Shape s;
  s.positions = sheet.positions;
  s.uvs = sheet.uvs;
  s.normals.assign(s.positions.size(), glm::vec3(0, 1, 0));
  const auto triangle = [](Shape& t, uint32_t a, uint32_t b, uint32_t c) {
    if (t.positions[a] != t.positions[b] && t.positions[b] != t.positions[c] &&
        t.positions[c] != t.positions[a])
      t.indices.insert(t.indices.end(), {a, b, c});
  };
  for (uint32_t j = 0; j < sheet.rows; ++j)
    for (uint32_t i = 0; i < sheet.columns; ++i) {
      const uint32_t ul = uint32_t(sheet.index(i, j)), ur = ul + 1, ll = uint32_t(sheet.index(i, j + 1)),
                     lr = ll + 1;
      triangle(s, ul, ll, lr);
      triangle(s, ul, lr, ur);
    }
  smooth(s, 75);
  if (thickness <= 0) return s;

  const std::vector<glm::vec3> normals = s.normals;
  const uint32_t count = uint32_t(s.positions.size());
  Shape front = s, back = s;
  for (uint32_t v = 0; v < count; ++v) {
    front.positions[v] += 0.5f * thickness * normals[v];
    back.positions[v] -= 0.5f * thickness * normals[v];
    back.normals[v] = -normals[v];
  }
  for (size_t k = 0; k < back.indices.size(); k += 3) std::swap(back.indices[k + 1], back.indices[k + 2]);
  // The rim: edges of a single triangle.
  std::unordered_map<uint64_t, uint32_t> edges;
  const auto key = [](uint32_t a, uint32_t b) { return uint64_t(a) << 32 | b; };
  for (size_t k = 0; k < s.indices.size(); ++k) {
    const uint32_t a = s.indices[k], b = s.indices[k % 3 == 2 ? k - 2 : k + 1];
    ++edges[key(a, b)];
  }
  Shape rim;
  for (size_t k = 0; k < s.indices.size(); ++k) {
    const uint32_t a = s.indices[k], b = s.indices[k % 3 == 2 ? k - 2 : k + 1];
    if (edges.count(key(b, a)) != 0) continue;
    const uint32_t base = uint32_t(rim.positions.size());
    for (const auto& [side, v] : {std::pair{&front, a}, {&back, a}, {&back, b}, {&front, b}}) {
      rim.positions.push_back(side->positions[v]);
      rim.normals.push_back({0, 1, 0});
      rim.uvs.push_back(s.uvs[v]);
    }
    for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) rim.indices.push_back(base + i);
  }
  smooth(rim, 60);
  append(front, back);
  append(front, rim);
  return front;
}

SubdivisionCage cage(const Sheet& sheet, uint32_t level, const std::vector<Sheet>& shapes) {
  SubdivisionCage c;
  c.level = level;
  c.positions = sheet.positions;
  c.uvs = sheet.uvs;
  for (uint32_t j = 0; j < sheet.rows; ++j)
    for (uint32_t i = 0; i < sheet.columns; ++i) {
      const uint32_t ul = uint32_t(sheet.index(i, j)), ll = uint32_t(sheet.index(i, j + 1));
      c.faceSizes.push_back(4);
      c.faceVertices.insert(c.faceVertices.end(), {ul, ll, ll + 1, ul + 1});
    }
  c.faceUvs = c.faceVertices;
  for (const Sheet& shape : shapes) {
    MorphTarget t;
    for (size_t i = 0; i < c.positions.size(); ++i)
      t.positions.push_back(shape.positions[i] - c.positions[i]);
    c.targets.push_back(std::move(t));
  }
  return c;
}

void append(Shape& shape, const Shape& what, const glm::mat4& m) {
  const uint32_t base = uint32_t(shape.positions.size());
  const glm::mat3 linear(m);
  const bool mirrored = glm::determinant(linear) < 0;
  // The cofactor matrix, which is the inverse transpose up to a factor.
  const glm::mat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                           glm::cross(linear[0], linear[1]));
  for (const glm::vec3& p : what.positions) shape.positions.push_back(glm::vec3(m * glm::vec4(p, 1)));
  for (const glm::vec3& n : what.normals)
    shape.normals.push_back(glm::normalize((mirrored ? -1.0f : 1.0f) * (cofactor * n)));
  shape.uvs.insert(shape.uvs.end(), what.uvs.begin(), what.uvs.end());
  for (size_t i = 0; i + 2 < what.indices.size(); i += 3)
    for (size_t k : {size_t(0), size_t(mirrored ? 2 : 1), size_t(mirrored ? 1 : 2)})
      shape.indices.push_back(base + what.indices[i + k]);
}

Shape placed(Shape shape, const glm::mat4& placement) {
  Shape s;
  append(s, shape, placement);
  return s;
}

Shape bent(Shape shape, const std::function<glm::vec3(glm::vec3)>& f, float creaseDegrees) {
  for (glm::vec3& p : shape.positions) p = f(p);
  smooth(shape, creaseDegrees);
  return shape;
}

void smooth(Shape& s, float creaseDegrees) {
  const float crease = std::cos(glm::radians(creaseDegrees));
  const size_t triangles = s.indices.size() / 3;
  std::vector<glm::vec3> faceNormals(triangles), cornerNormals(s.indices.size());
  for (size_t t = 0; t < triangles; ++t) {
    const glm::vec3 p[3] = {s.positions[s.indices[3 * t]], s.positions[s.indices[3 * t + 1]],
                            s.positions[s.indices[3 * t + 2]]};
    const glm::vec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    faceNormals[t] = glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0);
    for (int k = 0; k < 3; ++k) {  // weighted by the angle, so independent of how quads are split
      const glm::vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      const float angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      cornerNormals[3 * t + size_t(k)] = angle * faceNormals[t];
    }
  }
  const Corners corners = cornersOf(s);
  const size_t vertexCount = s.positions.size();
  std::vector<uint32_t> firstOf(vertexCount, kNoIndex), nextOf(vertexCount, kNoIndex);
  s.normals.assign(vertexCount, glm::vec3(0, 1, 0));
  for (uint32_t k = 0; k < s.indices.size(); ++k) {
    const uint32_t place = corners.placeOf[k], v = s.indices[k];
    glm::vec3 sum(0);
    for (uint32_t i = corners.first[place]; i < corners.first[place + 1]; ++i)
      if (const uint32_t other = corners.list[i];
          glm::dot(faceNormals[other / 3], faceNormals[k / 3]) >= crease)
        sum += cornerNormals[other];
    const glm::vec3 n = glm::length(sum) > 1e-9f             ? glm::normalize(sum)
                        : faceNormals[k / 3] != glm::vec3(0) ? faceNormals[k / 3]
                                                             : glm::vec3(0, 1, 0);
    if (firstOf[v] == kNoIndex) {
      firstOf[v] = v;
      s.normals[v] = n;
      continue;
    }
    uint32_t copy = v;  // v itself or a copy split off from it
    while (glm::dot(s.normals[copy], n) < 0.99999f && nextOf[copy] != kNoIndex) copy = nextOf[copy];
    if (glm::dot(s.normals[copy], n) < 0.99999f) {
      nextOf[copy] = uint32_t(s.positions.size());
      copy = nextOf[copy];
      nextOf.push_back(kNoIndex);
      s.positions.push_back(glm::vec3(s.positions[v]));
      s.normals.push_back(n);
      s.uvs.push_back(glm::vec2(s.uvs[v]));
    }
    s.indices[k] = copy;
  }
}

size_t triangleCount(const Shape& shape) { return shape.indices.size() / 3; }

MeshBuilder& MeshBuilder::add(uint32_t material, const Shape& shape, const glm::mat4& placement) {
  for (Shape& s : byMaterial_)
    if (s.material == material) {
      append(s, shape, placement);
      return *this;
    }
  byMaterial_.emplace_back();
  byMaterial_.back().material = material;
  append(byMaterial_.back(), shape, placement);
  return *this;
}

MeshBuilder& MeshBuilder::add(const MeshBuilder& other, const glm::mat4& placement) {
  for (const Shape& s : other.byMaterial_) add(s.material, s, placement);
  return *this;
}

size_t MeshBuilder::triangles() const {
  size_t count = 0;
  for (const Shape& s : byMaterial_) count += triangleCount(s);
  return count;
}

Mesh MeshBuilder::take(std::string name) {
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.primitives = std::move(byMaterial_);
  byMaterial_.clear();
  return mesh;
}

SceneBuilder::SceneBuilder(const std::string& name) { scene.name = scene.source = name; }

uint32_t SceneBuilder::texture(Texture texture) {
  scene.textures.push_back(std::move(texture));
  return uint32_t(scene.textures.size() - 1);
}

uint32_t SceneBuilder::material(const std::string& name, glm::vec3 color, const MaterialOptions& o) {
  Material m;
  m.name = name;
  m.baseColor = glm::vec4(color, 1);
  m.doubleSided = o.doubleSided;
  m.emission = o.emission;
  m.masked = o.alphaCutoff > 0;
  if (m.masked) m.alphaCutoff = o.alphaCutoff;
  if (o.texture != kNoIndex) {
    m.baseColorTexture.texture = o.texture;
    const float c = std::cos(glm::radians(o.turnDegrees)), s = std::sin(glm::radians(o.turnDegrees));
    const glm::vec2 perMetre = 1.0f / glm::vec2(o.metres, o.metresHigh > 0 ? o.metresHigh : o.metres);
    m.baseColorTexture.transform =
        glm::mat3x2(glm::vec2(c, s) * perMetre, glm::vec2(-s, c) * perMetre, o.offset * perMetre);
  }
  scene.materials.push_back(std::move(m));
  return uint32_t(scene.materials.size() - 1);
}

uint32_t SceneBuilder::mesh(const std::string& name, MeshBuilder shapes) {
  scene.meshes.push_back(shapes.take(name));
  return uint32_t(scene.meshes.size() - 1);
}

uint32_t SceneBuilder::mesh(const std::string& name, SubdivisionCage cage, uint32_t material) {
  if (cage.faceMaterials.empty()) cage.faceMaterials.assign(cage.faceSizes.size(), material);
  Mesh m;
  m.name = name;
  m.weights.assign(cage.targets.size(), 0.0f);
  m.cage = std::make_shared<const SubdivisionCage>(std::move(cage));
  scene.meshes.push_back(std::move(m));
  return uint32_t(scene.meshes.size() - 1);
}

uint32_t SceneBuilder::place(const std::string& name, uint32_t mesh, glm::vec3 position, float turnYDegrees,
                             glm::vec3 scale) {
  Node n;
  n.name = name;
  n.mesh = mesh;
  n.translation = position;
  n.rotation = glm::angleAxis(glm::radians(turnYDegrees), glm::vec3(0, 1, 0));
  n.scale = scale;
  scene.nodes.push_back(std::move(n));
  return uint32_t(scene.nodes.size() - 1);
}

void SceneBuilder::swing(uint32_t node, const std::vector<Swing>& swings, float loopSeconds) {
  constexpr int kKeys = 48;  // cubic between keys with the slopes of the sine; error below 1e-4
  AnimationChannel c;
  c.node = node;
  c.path = AnimationChannel::Path::Weights;
  c.interpolation = AnimationChannel::Interpolation::CubicSpline;
  for (int k = 0; k <= kKeys; ++k) {
    const float t = loopSeconds * float(k) / float(kKeys);
    c.times.push_back(t);
    std::vector<float> values, slopes;
    for (const Swing& s : swings) {
      const float rate = glm::two_pi<float>() / s.period, angle = rate * t + glm::two_pi<float>() * s.phase;
      values.push_back(s.amplitude * std::sin(angle));
      slopes.push_back(s.amplitude * rate * std::cos(angle));
    }
    for (const std::vector<float>* part : {&slopes, &values, &slopes})
      c.values.insert(c.values.end(), part->begin(), part->end());
    if (k == 0) scene.nodes[node].weights = values;
  }
  scene.nodes[node].dynamic = true;
  Animation a;
  a.name = scene.nodes[node].name;
  a.channels.push_back(std::move(c));
  a.plays = true;
  scene.animations.push_back(std::move(a));
}

void SceneBuilder::sun(const std::string& name, glm::vec3 color, float lux, glm::vec3 direction) {
  Light l;
  l.name = name;
  l.color = color;
  l.intensity = lux;
  l.direction = glm::normalize(direction);
  scene.lights.push_back(l);
}

void SceneBuilder::camera(glm::vec3 eye, glm::vec3 target, float verticalFovDegrees, float zNear) {
  Camera c;
  c.name = "still";
  c.position = eye;
  c.orientation = lookAlong(glm::normalize(target - eye), {0, 1, 0});
  c.verticalFov = glm::radians(verticalFovDegrees);
  c.zNear = zNear;
  scene.cameras.push_back(c);
}

Scene SceneBuilder::finish(float exposure, glm::vec2 gaze) {
  scene.exposure = exposure;
  scene.gaze.push_back({0.0f, gaze, true});
  for (const Mesh& m : scene.meshes)
    if (m.cage) {
      refineCages(scene);
      break;
    }
  scene.hash = contentHash(scene);
  return std::move(scene);
}

}  // namespace fovea::scene::model
