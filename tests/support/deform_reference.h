// Animated and deformed meshes in double precision, straight from glTF 2.0 (3.7.3, 3.7.2.2, appendix C).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::test {

class DeformReference {
 public:
  // Times of the animation that plays, not looped; `time` lies between its first and last key.
  DeformReference(const scene::Scene& s, double time) : scene_(s), time_(time) {}

  glm::dmat4 world(uint32_t node) {
    const auto known = world_.find(node);
    if (known != world_.end()) return known->second;
    const scene::Node& n = scene_.nodes[node];
    glm::dmat4 m(1.0);
    if (n.matrix) {
      m = glm::dmat4(*n.matrix);
    } else {
      glm::dvec3 t(n.translation), s(n.scale);
      glm::dquat r(n.rotation);
      using Path = scene::AnimationChannel::Path;
      if (const auto v = value(node, Path::Translation); !v.empty()) t = {v[0], v[1], v[2]};
      if (const auto v = value(node, Path::Scale); !v.empty()) s = {v[0], v[1], v[2]};
      if (const auto v = value(node, Path::Rotation); !v.empty()) r = glm::dquat(v[3], v[0], v[1], v[2]);
      m = glm::mat4_cast(r);
      for (int i = 0; i < 3; ++i) m[i] *= s[i];
      m[3] = glm::dvec4(t, 1.0);
    }
    if (n.parent != scene::kNoIndex) m = world(n.parent) * m;
    return world_[node] = m;
  }

  std::vector<double> weights(uint32_t node) {
    std::vector<double> w = value(node, scene::AnimationChannel::Path::Weights);
    const scene::Mesh& mesh = scene_.meshes[scene_.nodes[node].mesh];
    if (w.empty()) w.assign(scene_.nodes[node].weights.begin(), scene_.nodes[node].weights.end());
    if (w.empty()) w.assign(mesh.weights.begin(), mesh.weights.end());
    return w;
  }

  struct Vertex {
    glm::dvec3 position, normal;
  };
  // All primitives of a node's mesh, one after the other.
  std::vector<Vertex> vertices(uint32_t node) {
    std::vector<Vertex> list;
    const scene::Node& n = scene_.nodes[node];
    const std::vector<double> w = weights(node);
    for (const scene::Primitive& p : scene_.meshes[n.mesh].primitives)
      for (size_t i = 0; i < p.positions.size(); ++i) {
        glm::dvec3 position(p.positions[i]), normal(p.normals[i]);
        for (size_t t = 0; t < p.targets.size() && t < w.size(); ++t) {
          if (!p.targets[t].positions.empty()) position += w[t] * glm::dvec3(p.targets[t].positions[i]);
          if (!p.targets[t].normals.empty()) normal += w[t] * glm::dvec3(p.targets[t].normals[i]);
        }
        glm::dmat4 m = n.skin == scene::kNoIndex || p.joints.empty() ? world(node) : glm::dmat4(0.0);
        if (n.skin != scene::kNoIndex && !p.joints.empty())
          for (size_t k = 0; k < 4 * p.joints.size() / p.positions.size(); ++k) {
            const scene::Skin& skin = scene_.skins[n.skin];
            const size_t entry = i + k / 4 * p.positions.size();
            const uint32_t joint = p.joints[entry][int(k % 4)];
            m += double(p.weights[entry][int(k % 4)]) *
                 (world(skin.joints[joint]) * glm::dmat4(skin.inverseBind[joint]));
          }
        const glm::dvec3 turned = glm::transpose(glm::inverse(glm::dmat3(m))) * normal;
        list.push_back({glm::dvec3(m * glm::dvec4(position, 1.0)), glm::normalize(turned)});
      }
    return list;
  }

 private:
  // Keys of the channel that moves this; empty if none does.
  std::vector<double> value(uint32_t node, scene::AnimationChannel::Path path) const {
    for (const scene::Animation& a : scene_.animations)
      for (const scene::AnimationChannel& c : a.channels)
        if (a.plays && c.node == node && c.path == path) return sample(c);
    return {};
  }

  std::vector<double> sample(const scene::AnimationChannel& c) const {
    using Interpolation = scene::AnimationChannel::Interpolation;
    const bool cubic = c.interpolation == Interpolation::CubicSpline;
    const size_t keys = c.times.size(), n = c.values.size() / keys / (cubic ? 3 : 1);
    const auto at = [&](size_t key, size_t group, size_t i) {
      return double(c.values[(key * (cubic ? 3 : 1) + group) * n + i]);
    };
    size_t k = 0;
    while (k + 1 < keys && double(c.times[k + 1]) <= time_) ++k;
    const bool holds = k + 1 == keys || time_ < c.times[0] || c.interpolation == Interpolation::Step;
    std::vector<double> v(n);
    for (size_t i = 0; i < n; ++i) v[i] = at(k, cubic ? 1 : 0, i);
    if (!holds) {
      const double d = double(c.times[k + 1]) - double(c.times[k]), t = (time_ - double(c.times[k])) / d;
      if (cubic) {
        for (size_t i = 0; i < n; ++i)
          v[i] = (2 * t * t * t - 3 * t * t + 1) * at(k, 1, i) +
                 d * (t * t * t - 2 * t * t + t) * at(k, 2, i) +
                 (-2 * t * t * t + 3 * t * t) * at(k + 1, 1, i) + d * (t * t * t - t * t) * at(k + 1, 0, i);
      } else if (c.path == scene::AnimationChannel::Path::Rotation) {
        double dot = 0;
        for (size_t i = 0; i < 4; ++i) dot += at(k, 0, i) * at(k + 1, 0, i);
        const double sign = dot < 0 ? -1 : 1, angle = std::acos(std::min(1.0, std::abs(dot)));
        for (size_t i = 0; i < 4; ++i)
          v[i] =
              angle < 1e-6
                  ? (1 - t) * at(k, 0, i) + t * sign * at(k + 1, 0, i)
                  : (std::sin((1 - t) * angle) * at(k, 0, i) + std::sin(t * angle) * sign * at(k + 1, 0, i)) /
                        std::sin(angle);
      } else {
        for (size_t i = 0; i < n; ++i) v[i] = (1 - t) * at(k, 0, i) + t * at(k + 1, 0, i);
      }
    }
    if (c.path == scene::AnimationChannel::Path::Rotation) {
      double length = 0;
      for (double x : v) length += x * x;
      for (double& x : v) x /= std::sqrt(length);
    }
    return v;
  }

  const scene::Scene& scene_;
  double time_;
  std::map<uint32_t, glm::dmat4> world_;
};

// Largest distance between the moved vertices and those of the reference, relative to `scale`; likewise for normals.
inline double deformError(const scene::Scene& s, const scene::Geometry& g, double time, double scale) {
  DeformReference reference(s, time);
  double worst = 0;
  for (const scene::Object& object : g.objects) {
    if (!object.dynamic) continue;
    uint32_t v = object.firstVertex;
    for (const DeformReference::Vertex& expected : reference.vertices(object.node)) {
      worst = std::max(worst, glm::distance(glm::dvec3(g.positions[v]), expected.position) / scale);
      worst = std::max(worst, glm::distance(glm::dvec3(g.normals[v]), expected.normal));
      ++v;
    }
  }
  return worst;
}

}  // namespace fovea::test
