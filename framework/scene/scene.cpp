#include "framework/scene/scene.h"

#include <xxhash.h>

#include <algorithm>
#include <memory>

#include "framework/scene/lights.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace {

// Streaming content hash. Every variable-length field is preceded by its length, so that bytes cannot move from one
// field to its neighbour.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_64bits_reset(state_.get()); }
  void bytes(const void* data, size_t size) {
    if (size > 0) XXH3_64bits_update(state_.get(), data, size);
  }
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(&v, sizeof v);
  }
  void floats(const float* v, size_t count) { bytes(v, count * sizeof(float)); }
  void text(const std::string& s) {
    value(uint64_t(s.size()));
    bytes(s.data(), s.size());
  }
  template <class T>
  void array(const std::vector<T>& v) {
    value(uint64_t(v.size()));
    bytes(v.data(), v.size() * sizeof(T));
  }
  uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

void hash(Hasher& h, const TextureUse& use) {
  h.value(use.texture);
  h.value(uint32_t(use.wrapU));
  h.value(uint32_t(use.wrapV));
  h.floats(&use.transform[0][0], 6);
}

void hash(Hasher& h, const Material& m) {
  h.floats(&m.baseColor[0], 4);
  hash(h, m.baseColorTexture);
  h.value(m.metallic);
  h.floats(&m.emission[0], 3);
  hash(h, m.emissionTexture);
  h.value(uint32_t(m.masked) | uint32_t(m.doubleSided) << 1);
  h.value(m.alphaCutoff);
}

void hash(Hasher& h, const Node& n) {
  h.value(n.parent);
  const glm::mat4 local = localTransform(n);
  h.floats(&local[0][0], 16);
  h.value(n.mesh);
  h.value(uint32_t(n.dynamic));
}

void hash(Hasher& h, const Light& l) {
  h.value(uint32_t(l.type));
  h.floats(&l.color[0], 3);
  const float scalars[] = {l.intensity, l.range, l.innerConeAngle, l.outerConeAngle};
  h.floats(scalars, 4);
  h.floats(&l.position[0], 3);
  h.floats(&l.direction[0], 3);
}

void hash(Hasher& h, const Camera& c) {
  h.floats(&c.position[0], 3);
  const float scalars[] = {c.orientation.w, c.orientation.x, c.orientation.y, c.orientation.z,
                           c.verticalFov,   c.zNear,         c.zFar};
  h.floats(scalars, 7);
}

template <class Motion>
void hashPath(Hasher& h, uint32_t what, const Motion& m) {
  h.value(what);
  h.value(uint32_t(m.smooth) | uint32_t(m.repeat) << 1);
  h.value(uint64_t(m.keys.size()));
}

void hash(Hasher& h, const Primitive& p) {
  if (!p.lightIndices.empty()) h.array(p.lightIndices);
  if (p.targets.empty() && p.joints.empty()) return;
  for (const MorphTarget& t : p.targets) {
    h.array(t.positions);
    h.array(t.normals);
  }
  h.array(p.joints);
  h.array(p.weights);
}

// At rest, the primitives contain everything.
void hash(Hasher& h, const SubdivisionCage& cage) {
  if (cage.targets.empty() && cage.joints.empty()) return;
  h.array(cage.positions);
  for (const MorphTarget& t : cage.targets) h.array(t.positions);
  h.array(cage.joints);
  h.array(cage.weights);
}

// Adds what deforms, and how.
void hashAnimation(Hasher& h, const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& p : mesh.primitives) hash(h, p);
    if (!mesh.weights.empty()) h.array(mesh.weights);
    if (mesh.cage) hash(h, *mesh.cage);
  }
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    if (n.skin == kNoIndex && n.weights.empty()) continue;
    h.value(uint64_t(i));
    h.value(n.skin);
    h.array(n.weights);
  }
  for (const Skin& s : scene.skins) {
    h.array(s.joints);
    h.array(s.inverseBind);
  }
  for (const Animation& a : scene.animations) {
    if (!a.plays) continue;
    h.value(a.speed);
    h.value(uint32_t(a.repeat));
    for (const AnimationChannel& c : a.channels) {
      h.value(c.node);
      h.value(uint32_t(c.path) | uint32_t(c.interpolation) << 8);
      h.array(c.times);
      h.array(c.values);
    }
  }
}

// Adds nothing for a scene without motion, so that its hash does not depend on this function.
void hashMotion(Hasher& h, const Scene& scene) {
  for (const Mover& m : scene.movers) {
    hashPath(h, m.node, m);
    for (const MotionKey& k : m.keys) {
      const float values[] = {k.time,          k.translation.x, k.translation.y,
                              k.translation.z, k.rotation.w,    k.rotation.x,
                              k.rotation.y,    k.rotation.z,    k.visible ? 1.0f : 0.0f};
      h.floats(values, 9);
    }
  }
  for (const LightMotion& m : scene.lightMotions) {
    hashPath(h, ~m.light, m);
    for (const LightKey& k : m.keys) {
      h.value(k.time);
      for (const glm::vec3& v : {k.position, k.direction, k.color}) h.floats(&v[0], 3);
      h.value(k.intensity);
    }
  }
  for (size_t i = 0; i < scene.gaze.size(); ++i)
    for (const auto& eye : {scene.gaze[i].left, scene.gaze[i].right})
      if (eye) {
        h.value(uint64_t(i));
        h.floats(&(*eye)[0], 2);
      }
  if (scene.ipd != Scene{}.ipd) h.value(scene.ipd);
  if (scene.lens) {
    const float angles[] = {scene.lens->outward, scene.lens->inward, scene.lens->up, scene.lens->down};
    h.floats(angles, 4);
  }
}

}  // namespace

glm::mat4 localTransform(const Node& node) {
  if (node.matrix) return *node.matrix;
  glm::mat4 m = glm::mat4_cast(node.rotation);
  m[0] *= node.scale.x;
  m[1] *= node.scale.y;
  m[2] *= node.scale.z;
  m[3] = glm::vec4(node.translation, 1.0f);
  return m;
}

std::vector<glm::mat4> worldTransforms(const Scene& scene) {
  std::vector<glm::mat4> world(scene.nodes.size());
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    world[i] = localTransform(node);
    if (node.parent != kNoIndex) world[i] = world[node.parent] * world[i];
  }
  return world;
}

uint64_t contentHash(const Scene& scene) {
  Hasher h;
  h.value(uint64_t(scene.textures.size()));
  for (const Texture& t : scene.textures) {
    h.value(t.width);
    h.value(t.height);
    h.value(uint32_t(t.srgb));
    h.array(t.rgba);
  }
  h.value(uint64_t(scene.materials.size()));
  for (const Material& m : scene.materials) hash(h, m);
  h.value(uint64_t(scene.meshes.size()));
  for (const Mesh& mesh : scene.meshes) {
    h.value(uint64_t(mesh.primitives.size()));
    for (const Primitive& p : mesh.primitives) {
      h.array(p.positions);
      h.array(p.normals);
      h.array(p.uvs);
      h.array(p.indices);
      h.value(p.material);
    }
  }
  h.value(uint64_t(scene.nodes.size()));
  for (const Node& n : scene.nodes) hash(h, n);
  h.value(uint64_t(scene.lights.size()));
  for (const Light& l : scene.lights) hash(h, l);
  h.value(uint64_t(scene.cameras.size()));
  for (const Camera& c : scene.cameras) hash(h, c);
  h.value(uint64_t(scene.cameraPath.size()));
  for (const CameraKey& k : scene.cameraPath) {
    h.value(k.time);
    hash(h, k.camera);
  }
  h.value(uint64_t(scene.gaze.size()));
  for (const GazeSample& g : scene.gaze) {
    h.value(g.time);
    h.floats(&g.position[0], 2);
    h.value(uint32_t(g.valid));
  }
  h.value(scene.exposure);
  h.floats(&scene.environment[0], 3);
  hashMotion(h, scene);
  hashAnimation(h, scene);
  return h.digest();
}

std::vector<std::pair<std::string, int64_t>> quantities(const Scene& scene, const Geometry& geometry) {
  const auto atLeastOne = [](size_t value) { return std::max<int64_t>(1, static_cast<int64_t>(value)); };
  return {{"scene.triangles", atLeastOne(geometry.triangles.size())},
          {"scene.static_triangles", atLeastOne(geometry.staticTriangles)},
          {"scene.vertices", atLeastOne(geometry.positions.size())},
          {"scene.lights", atLeastOne(scene.lights.size())},
          {"scene.shadow_layers", atLeastOne(shadowLayers(scene.lights))}};
}

}  // namespace fovea::scene
