#include "framework/scene/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fovea::scene {
namespace {

constexpr int kSweepSteps = 32;  // samples of a path between two keys

// Catmull-Rom through the four keys around u in [0, 1] between p1 and p2, with the keys' own times (finite
// differences).
template <class V>
V hermite(const V& p0, const V& p1, const V& p2, const V& p3, float t0, float t1, float t2, float t3,
          float u) {
  const float span = t2 - t1;
  const V m1 = (p2 - p0) * (span / (t2 - t0));
  const V m2 = (p3 - p1) * (span / (t3 - t1));
  const float u2 = u * u, u3 = u2 * u;
  return p1 * (2 * u3 - 3 * u2 + 1) + m1 * (u3 - 2 * u2 + u) + p2 * (3 * u2 - 2 * u3) + m2 * (u3 - u2);
}

glm::quat sameSide(const glm::quat& q, const glm::quat& reference) {
  return glm::dot(q, reference) < 0 ? -q : q;
}

// The two keys around a time and their neighbours.
struct Span {
  size_t i0, i1, i2, i3;
  float t0, t1, t2, t3;
  float u;  // from i1 to i2
  bool holds() const { return i1 == i2; }
};

template <class Key>
Span spanAt(const std::vector<Key>& keys, float time) {
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), time, [](float t, const Key& k) { return t < k.time; });
  const size_t last = keys.size() - 1, i2 = std::min(size_t(after - keys.begin()), last);
  const bool holds = after == keys.begin() || after == keys.end();
  const size_t i1 = holds ? i2 : i2 - 1, i0 = i1 > 0 ? i1 - 1 : i1, i3 = std::min(i2 + 1, last);
  Span s{i0, i1, i2, i3, keys[i0].time, keys[i1].time, keys[i2].time, keys[i3].time, 0};
  if (!holds) s.u = (time - s.t1) / (s.t2 - s.t1);
  return s;
}

// Catmull-Rom that never leaves the interval between two keys (Fritsch and Carlson 1980): where a path rests
// or turns, it does so in the keys, so that nothing sinks into the floor on which it stands.
float monotone(float p0, float p1, float p2, float p3, const Span& s) {
  const auto tangent = [](float before, float after, float mean) {
    if (before * after <= 0) return 0.0f;
    return std::copysign(std::min({std::abs(mean), 3 * std::abs(before), 3 * std::abs(after)}), after);
  };
  const float length = s.t2 - s.t1, slope = (p2 - p1) / length;
  const float before = s.i0 < s.i1 ? (p1 - p0) / (s.t1 - s.t0) : slope;
  const float after = s.i2 < s.i3 ? (p3 - p2) / (s.t3 - s.t2) : slope;
  const float m1 = length * tangent(before, slope, (p2 - p0) / (s.t2 - s.t0));
  const float m2 = length * tangent(slope, after, (p3 - p1) / (s.t3 - s.t1));
  const float u = s.u, u2 = u * u, u3 = u2 * u;
  return p1 + (p2 - p1) * (3 * u2 - 2 * u3) + m1 * (u3 - 2 * u2 + u) + m2 * (u3 - u2);
}

float between(float p0, float p1, float p2, float p3, const Span& s, bool smooth) {
  return smooth ? monotone(p0, p1, p2, p3, s) : p1 + (p2 - p1) * s.u;
}

glm::vec3 between(glm::vec3 p0, glm::vec3 p1, glm::vec3 p2, glm::vec3 p3, const Span& s, bool smooth) {
  glm::vec3 r;
  for (int c = 0; c < 3; ++c) r[c] = between(p0[c], p1[c], p2[c], p3[c], s, smooth);
  return r;
}

// The same spline on the sphere of rotations (then normalised): no jump of the turning speed at a key.
glm::quat turn(const glm::quat& k0, const glm::quat& q1, const glm::quat& k2, const glm::quat& k3,
               const Span& s) {
  const glm::quat q2 = sameSide(k2, q1);
  return glm::normalize(hermite(sameSide(k0, q1), q1, q2, sameSide(k3, q2), s.t0, s.t1, s.t2, s.t3, s.u));
}

Camera cameraOnPath(const std::vector<CameraKey>& path, float time) {
  const Span s = spanAt(path, time);
  if (s.holds()) return path[s.i1].camera;
  const Camera &k0 = path[s.i0].camera, &k1 = path[s.i1].camera, &k2 = path[s.i2].camera,
               &k3 = path[s.i3].camera;
  Camera c = k1;
  c.position = hermite(k0.position, k1.position, k2.position, k3.position, s.t0, s.t1, s.t2, s.t3, s.u);
  c.orientation = turn(k0.orientation, k1.orientation, k2.orientation, k3.orientation, s);
  c.verticalFov = glm::mix(k1.verticalFov, k2.verticalFov, s.u);
  return c;
}

template <class Key>
float repeated(const std::vector<Key>& keys, Repeat repeat, double time) {
  const double first = keys.front().time, period = double(keys.back().time) - first;
  if (repeat == Repeat::Once || time <= first || period <= 0) return float(time);
  const double t = std::fmod(time - first, repeat == Repeat::Loop ? period : 2 * period);
  return float(first + (t > period ? 2 * period - t : t));
}

void move(Light& light, const LightMotion& motion, double time) {
  const std::vector<LightKey>& keys = motion.keys;
  const Span s = spanAt(keys, repeated(keys, motion.repeat, time));
  const LightKey &k0 = keys[s.i0], &k1 = keys[s.i1], &k2 = keys[s.i2], &k3 = keys[s.i3];
  light.position = k1.position, light.direction = k1.direction;
  light.color = k1.color, light.intensity = k1.intensity;
  if (s.holds()) return;
  const bool smooth = motion.smooth;
  light.position = between(k0.position, k1.position, k2.position, k3.position, s, smooth);
  light.color = between(k0.color, k1.color, k2.color, k3.color, s, smooth);
  light.intensity = between(k0.intensity, k1.intensity, k2.intensity, k3.intensity, s, smooth);
  const glm::vec3 direction = between(k0.direction, k1.direction, k2.direction, k3.direction, s, smooth);
  if (glm::length(direction) > 1e-6f) light.direction = glm::normalize(direction);
}

}  // namespace

Camera cameraAt(const Scene& scene, double time) {
  if (!scene.cameraPath.empty()) return cameraOnPath(scene.cameraPath, float(time));
  return scene.cameras.empty() ? Camera{} : scene.cameras.front();
}

GazeSample gazeAt(const std::vector<GazeSample>& gaze, double time) {
  GazeSample sample;
  bool found = false;
  for (const GazeSample& g : gaze) {
    if (!g.valid) continue;
    if (found && double(g.time) > time) break;
    sample = g;
    found = true;
    if (double(g.time) > time) break;  // before the first valid sample: that one
  }
  return sample;
}

std::vector<Light> lightsAt(const Scene& scene, double time) {
  std::vector<Light> lights = scene.lights;
  for (const LightMotion& m : scene.lightMotions)
    if (m.light < lights.size() && !m.keys.empty()) move(lights[m.light], m, time);
  return lights;
}

MotionKey poseAt(const Mover& mover, double time) {
  const std::vector<MotionKey>& keys = mover.keys;
  const Span s = spanAt(keys, repeated(keys, mover.repeat, time));
  MotionKey pose = keys[s.i1];
  if (s.holds()) return pose;
  const MotionKey &k0 = keys[s.i0], &k1 = keys[s.i1], &k2 = keys[s.i2], &k3 = keys[s.i3];
  pose.translation = between(k0.translation, k1.translation, k2.translation, k3.translation, s, mover.smooth);
  pose.rotation = mover.smooth
                      ? turn(k0.rotation, k1.rotation, k2.rotation, k3.rotation, s)
                      : glm::normalize(glm::slerp(k1.rotation, sameSide(k2.rotation, k1.rotation), s.u));
  return pose;
}

NodePoses::NodePoses(const Scene& scene) : scene_(scene) {
  if (scene.movers.empty()) return;
  moverOfNode_.assign(scene.nodes.size(), kNoIndex);
  for (uint32_t m = 0; m < scene.movers.size(); ++m)
    if (!scene.movers[m].keys.empty()) moverOfNode_.at(scene.movers[m].node) = m;
}

const Mover* NodePoses::moverOf(uint32_t node) const {
  if (moverOfNode_.empty()) return nullptr;
  for (; node != kNoIndex; node = scene_.nodes[node].parent)
    if (moverOfNode_[node] != kNoIndex) return &scene_.movers[moverOfNode_[node]];
  return nullptr;
}

NodePoses::Pose NodePoses::at(uint32_t node, double time) const {
  Pose pose;
  for (; node != kNoIndex; node = scene_.nodes[node].parent) {
    const uint32_t mover = moverOfNode_.empty() ? kNoIndex : moverOfNode_[node];
    if (mover == kNoIndex) {
      pose.toWorld = localTransform(scene_.nodes[node]) * pose.toWorld;
      continue;
    }
    const MotionKey key = poseAt(scene_.movers[mover], time);
    Node moved = scene_.nodes[node];
    moved.matrix.reset();
    moved.translation = key.translation;
    moved.rotation = key.rotation;
    pose.toWorld = localTransform(moved) * pose.toWorld;
    pose.visible = pose.visible && key.visible;
  }
  return pose;
}

std::vector<ObjectTransform> objectsAt(const Scene& scene, const Geometry& geometry, double time,
                                       double before) {
  std::vector<ObjectTransform> list(geometry.objects.size());
  const NodePoses poses(scene);
  for (size_t i = 0; i < list.size(); ++i) {
    if (!geometry.objects[i].dynamic) continue;
    const NodePoses::Pose now = poses.at(geometry.objects[i].node, time);
    const NodePoses::Pose last = time == before ? now : poses.at(geometry.objects[i].node, before);
    const bool invertible = std::abs(glm::determinant(glm::dmat3(now.toWorld))) > 1e-30;
    list[i] = {now.toWorld, last.toWorld,
               invertible ? glm::mat4(glm::inverse(glm::dmat4(now.toWorld))) : glm::mat4(0), now.visible,
               last.visible};
  }
  return list;
}

Bounds sweptBounds(const NodePoses& poses, uint32_t node, const Mover& mover, const Bounds& mesh) {
  Bounds swept;
  std::array<glm::vec3, 8> last, beforeLast;  // the corners of the box one and two samples ago
  int known = 0;
  const auto sample = [&](double time) {
    const glm::mat4 toWorld = poses.at(node, time).toWorld;
    for (int c = 0; c < 8; ++c) {
      const glm::vec3 corner(c & 1 ? mesh.high.x : mesh.low.x, c & 2 ? mesh.high.y : mesh.low.y,
                             c & 4 ? mesh.high.z : mesh.low.z);
      const glm::vec3 p(toWorld * glm::vec4(corner, 1.0f));
      swept.include(p);
      // Between samples the path bulges by about an eighth of its second difference; a quarter is safe.
      if (known >= 2) {
        const glm::vec3 bulge = 0.25f * glm::abs(p - 2.0f * last[c] + beforeLast[c]);
        for (const glm::vec3& q : {beforeLast[c], last[c], p})
          swept.include(q - bulge), swept.include(q + bulge);
      }
      beforeLast[c] = last[c];
      last[c] = p;
    }
    ++known;
  };
  const std::vector<MotionKey>& keys = mover.keys;
  sample(keys.front().time);
  for (size_t i = 0; i + 1 < keys.size(); ++i) {
    known = 0;  // speed may jump in a key
    const double first = keys[i].time, length = keys[i + 1].time - first;
    for (int step = 0; step < kSweepSteps; ++step) sample(first + length * step / kSweepSteps);
    sample(first + length * (1 - 1e-9));  // a loop is back at its first key when it reaches the last
  }
  return swept;
}

}  // namespace fovea::scene
