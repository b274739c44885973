#include "framework/scene/scene.h"

#include <algorithm>
#include <memory>

#include "framework/base/hash.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/lights.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace {

void hash(Hasher& h, const TextureUse& use) {
  h.add(use.texture);
  h.add(uint32_t(use.wrapU));
  h.add(uint32_t(use.wrapV));
  h.add(&use.transform[0][0], 6);
  if (use.set != 0) h.add(use.set);
  if (use.nearest) h.add(~0u);
}

void hash(Hasher& h, const Material& m) {
  h.add(&m.baseColor[0], 4);
  h.add(&m.emission[0], 3);
  h.add(&m.specularColor[0], 3);
  for (const auto use : kMaterialTextures) hash(h, m.*use);
  h.add(uint32_t(m.masked) | uint32_t(m.doubleSided) << 1 | uint32_t(m.unlit) << 2 |
        uint32_t(m.blended) << 3);
  const float scalars[] = {m.metallic, m.metallicMean, m.alphaCutoff,  m.roughness, m.normalScale,
                           m.ior,      m.specular,     m.transmission, m.clearcoat, m.clearcoatRoughness};
  h.add(scalars, std::size(scalars));
}

void hash(Hasher& h, const Node& n) {
  h.add(n.parent);
  const glm::mat4 local = localTransform(n);
  h.add(&local[0][0], 16);
  h.add(n.mesh);
  h.add(uint32_t(n.dynamic));
}

void hash(Hasher& h, const Light& l) {
  h.add(uint32_t(l.type));
  h.add(&l.color[0], 3);
  const float scalars[] = {l.intensity, l.range, l.innerConeAngle, l.outerConeAngle};
  h.add(scalars, 4);
  h.add(&l.position[0], 3);
  h.add(&l.direction[0], 3);
}

void hash(Hasher& h, const Camera& c) {
  h.add(&c.position[0], 3);
  const float scalars[] = {c.orientation.w, c.orientation.x, c.orientation.y, c.orientation.z,
                           c.verticalFov,   c.zNear,         c.zFar};
  h.add(scalars, 7);
  if (c.aspectRatio != 0) h.add(c.aspectRatio);
}

template <class Motion>
void hashPath(Hasher& h, uint32_t what, const Motion& m) {
  h.add(what);
  h.add(uint32_t(m.smooth) | uint32_t(m.repeat) << 1);
  h.add(uint64_t(m.keys.size()));
}

void hash(Hasher& h, const Primitive& p) {
  if (!p.secondUvs.empty()) h.add(p.secondUvs);
  if (!p.colors.empty()) h.add(p.colors);
  if (!p.tangents.empty()) h.add(p.tangents);
  if (!p.lightIndices.empty()) h.add(p.lightIndices);
  if (p.targets.empty() && p.joints.empty()) return;
  for (const MorphTarget& t : p.targets) {
    h.add(t.positions);
    h.add(t.normals);
  }
  h.add(p.joints);
  h.add(p.weights);
}

// At rest, the primitives contain everything.
void hash(Hasher& h, const SubdivisionCage& cage) {
  if (cage.targets.empty() && cage.joints.empty()) return;
  h.add(cage.positions);
  for (const MorphTarget& t : cage.targets) h.add(t.positions);
  h.add(cage.joints);
  h.add(cage.weights);
}

// Adds what deforms, and how.
void hashAnimation(Hasher& h, const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& p : mesh.primitives) hash(h, p);
    if (!mesh.weights.empty()) h.add(mesh.weights);
    if (mesh.cage) hash(h, *mesh.cage);
  }
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    if (n.skin == kNoIndex && n.weights.empty()) continue;
    h.add(uint64_t(i));
    h.add(n.skin);
    h.add(n.weights);
  }
  for (const Skin& s : scene.skins) {
    h.add(s.joints);
    h.add(s.inverseBind);
  }
  for (const Animation& a : scene.animations) {
    if (!a.plays) continue;
    h.add(a.speed);
    h.add(uint32_t(a.repeat));
    for (const AnimationChannel& c : a.channels) {
      h.add(c.node);
      h.add(uint32_t(c.path) | uint32_t(c.interpolation) << 8);
      h.add(c.times);
      h.add(c.values);
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
      h.add(values, 9);
    }
  }
  for (const LightMotion& m : scene.lightMotions) {
    hashPath(h, ~m.light, m);
    for (const LightKey& k : m.keys) {
      h.add(k.time);
      for (const glm::vec3& v : {k.position, k.direction, k.color}) h.add(&v[0], 3);
      h.add(k.intensity);
    }
  }
  for (size_t i = 0; i < scene.gaze.size(); ++i)
    for (const auto& eye : {scene.gaze[i].left, scene.gaze[i].right})
      if (eye) {
        h.add(uint64_t(i));
        h.add(&(*eye)[0], 2);
      }
  if (scene.ipd != Scene{}.ipd) h.add(scene.ipd);
  if (scene.lens) {
    const float angles[] = {scene.lens->outward, scene.lens->inward, scene.lens->up, scene.lens->down};
    h.add(angles, 4);
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
  h.add(uint64_t(scene.textures.size()));
  for (const Texture& t : scene.textures) {
    h.add(t.width);
    h.add(t.height);
    h.add(uint32_t(t.srgb));
    h.add(t.rgba);
  }
  h.add(uint64_t(scene.materials.size()));
  for (const Material& m : scene.materials) hash(h, m);
  h.add(uint64_t(scene.meshes.size()));
  for (const Mesh& mesh : scene.meshes) {
    h.add(uint64_t(mesh.primitives.size()));
    for (const Primitive& p : mesh.primitives) {
      h.add(p.positions);
      h.add(p.normals);
      h.add(p.uvs);
      h.add(p.indices);
      h.add(p.material);
    }
  }
  h.add(uint64_t(scene.nodes.size()));
  for (const Node& n : scene.nodes) hash(h, n);
  h.add(uint64_t(scene.lights.size()));
  for (const Light& l : scene.lights) hash(h, l);
  h.add(uint64_t(scene.cameras.size()));
  for (const Camera& c : scene.cameras) hash(h, c);
  h.add(uint64_t(scene.cameraPath.size()));
  for (const CameraKey& k : scene.cameraPath) {
    h.add(k.time);
    hash(h, k.camera);
  }
  h.add(uint64_t(scene.gaze.size()));
  for (const GazeSample& g : scene.gaze) {
    h.add(g.time);
    h.add(&g.position[0], 2);
    h.add(uint32_t(g.valid));
  }
  h.add(scene.exposure);
  h.add(&scene.environment[0], 3);
  if (scene.environmentMap) {
    h.add(scene.environmentMap->texels());
    h.add(scene.environmentMap->turn());
  }
  hashMotion(h, scene);
  hashAnimation(h, scene);
  return h.value();
}

std::vector<std::pair<std::string, int64_t>> quantities(const Scene& scene, const Geometry& geometry) {
  const auto atLeastOne = [](size_t value) { return std::max<int64_t>(1, static_cast<int64_t>(value)); };
  return {{"scene.triangles", atLeastOne(geometry.triangles.size())},
          {"scene.static_triangles", atLeastOne(geometry.staticTriangles)},
          {"scene.vertices", atLeastOne(geometry.positions.size())},
          {"scene.lights", atLeastOne(scene.lights.size())},
          {"scene.shadow_layers", atLeastOne(shadowLayers(scene.lights))},
          {"scene.shadow_texels", atLeastOne(mostShadowTexels(shadowLayers(scene.lights)))}};
}

}  // namespace fovea::scene
