#include "framework/scene/motion/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <unordered_map>

#include "framework/scene/motion/animation.h"
#include "framework/scene/motion/deform.h"

namespace fovea::scene {
namespace {

constexpr int kSweepSteps = 32;        // samples of a path between two keys
constexpr int kSteps = 4;              // samples of an animation between two keys
constexpr size_t kMostSamples = 1024;  // samples of one object

// Catmull-Rom through the four keys around u in [0, 1] between p1 and p2, with the keys' own
// times (finite differences).
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

// Catmull-Rom spline that never leaves the interval between two keys (Fritsch and Carlson 1980): a path rests or
// turns only at keys, so that nothing sinks into the floor on which it stands.
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

// The same spline on the sphere of rotations, normalised afterwards: the angular velocity does not jump at a key.
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

bool anyPlays(const Scene& scene) {
  return std::any_of(scene.animations.begin(), scene.animations.end(),
                     [](const Animation& a) { return a.plays; });
}

// The first camera, placed by its node.
Camera carriedCamera(const Scene& scene, double time) {
  Camera camera = scene.cameras.front();
  if (scene.movers.empty() && !anyPlays(scene)) return camera;
  const auto node =
      std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.camera == 0; });
  if (node == scene.nodes.end()) return camera;
  const NodePoses poses(scene);
  const uint32_t index = uint32_t(node - scene.nodes.begin());
  if (!poses.animated(index) && !poses.moverOf(index)) return camera;
  const glm::mat4 toWorld = poses.at(index, time).toWorld;
  camera.position = glm::vec3(toWorld[3]);
  // A node's scale does not affect its camera; a mirrored camera still has its right side on the right.
  const glm::vec3 back(toWorld[2]), up(toWorld[1]), right = glm::cross(up, back);
  if (glm::length(right) > 1e-12f * glm::length(up) * glm::length(back))
    camera.orientation = glm::quat_cast(
        glm::mat3(glm::normalize(right), glm::normalize(glm::cross(back, right)), glm::normalize(back)));
  return camera;
}

// Lights attached to nodes of playing animations move with the nodes.
void carryLights(const Scene& scene, double time, std::vector<Light>& lights) {
  if (!anyPlays(scene)) return;
  const NodePoses poses(scene);
  std::vector<glm::mat4> rest;
  for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
    const uint32_t light = scene.nodes[i].light;
    if (light >= lights.size() || !poses.animated(i)) continue;
    if (rest.empty()) rest = worldTransforms(scene);
    if (std::abs(glm::determinant(glm::dmat3(rest[i]))) < 1e-30) continue;
    const glm::mat4 move(glm::dmat4(poses.at(i, time).toWorld) * glm::inverse(glm::dmat4(rest[i])));
    Light& l = lights[light];
    l.position = glm::vec3(move * glm::vec4(l.position, 1));
    const glm::vec3 direction = glm::mat3(move) * l.direction;
    if (glm::length(direction) > 1e-6f) l.direction = glm::normalize(direction);
  }
}

}  // namespace

Camera cameraAt(const Scene& scene, double time) {
  if (!scene.cameraPath.empty()) return cameraOnPath(scene.cameraPath, float(time));
  return scene.cameras.empty() ? Camera{} : carriedCamera(scene, time);
}

GazeSample gazeAt(const std::vector<GazeSample>& gaze, double time, double gap) {
  const auto valid = [](const GazeSample& g) { return g.valid; };
  const auto after = std::upper_bound(gaze.begin(), gaze.end(), time,
                                      [](double t, const GazeSample& g) { return t < double(g.time); });
  const auto back = std::find_if(std::make_reverse_iterator(after), gaze.rend(), valid);
  if (back == gaze.rend()) {
    const auto first = std::find_if(after, gaze.end(), valid);
    return first == gaze.end() ? GazeSample{} : *first;
  }
  GazeSample sample = *back;
  const bool blink = back != std::make_reverse_iterator(after);  // between the sample and now
  if (blink || after == gaze.end() || !after->valid) return sample;
  const double interval = double(after->time) - double(sample.time);
  if (interval > gap) return sample;
  const float u = float((time - double(sample.time)) / interval);
  const auto join = [u](glm::vec2& from, const glm::vec2& to) {
    if (glm::distance(from, to) <= kGazeJump) from += u * (to - from);
  };
  join(sample.position, after->position);
  if (sample.left && after->left) join(*sample.left, *after->left);
  if (sample.right && after->right) join(*sample.right, *after->right);
  return sample;
}

std::vector<Light> lightsAt(const Scene& scene, double time) {
  std::vector<Light> lights = scene.lights;
  carryLights(scene, time, lights);
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
  if (!scene.movers.empty()) moverOfNode_.assign(scene.nodes.size(), kNoIndex);
  for (uint32_t m = 0; m < scene.movers.size(); ++m)
    if (!scene.movers[m].keys.empty()) moverOfNode_.at(scene.movers[m].node) = m;
  for (const Animation& a : scene.animations) {
    if (!a.plays) continue;
    channels_.resize(scene.nodes.size());
    for (const AnimationChannel& c : a.channels)
      if (c.node < scene.nodes.size() && componentsOf(c) > 0) channels_[c.node].push_back({&a, &c});
  }
}

template <class Visit>
void NodePoses::eachAbove(uint32_t node, const Visit& visit) const {
  const uint32_t skin = skinned(scene_, scene_.nodes[node]) ? scene_.nodes[node].skin : kNoIndex;
  const auto up = [&](uint32_t n) {
    for (; n != kNoIndex; n = scene_.nodes[n].parent) visit(n);
  };
  up(node);
  if (skin == kNoIndex) return;
  for (uint32_t joint : scene_.skins[skin].joints) up(joint);
}

const Mover* NodePoses::moverOf(uint32_t node) const {
  if (moverOfNode_.empty()) return nullptr;
  for (; node != kNoIndex; node = scene_.nodes[node].parent)
    if (moverOfNode_[node] != kNoIndex) return &scene_.movers[moverOfNode_[node]];
  return nullptr;
}

bool NodePoses::moves(uint32_t node) const {
  if (!moverOfNode_.empty() && moverOfNode_[node] != kNoIndex) return true;
  return !channels_.empty() &&
         std::any_of(channels_[node].begin(), channels_[node].end(),
                     [](const Channel& c) { return c.channel->path != AnimationChannel::Path::Weights; });
}

bool NodePoses::reshapes(uint32_t node) const {
  return !channels_.empty() &&
         std::any_of(channels_[node].begin(), channels_[node].end(),
                     [](const Channel& c) { return c.channel->path == AnimationChannel::Path::Weights; });
}

bool NodePoses::animated(uint32_t node) const {
  if (channels_.empty()) return false;
  if (reshapes(node)) return true;
  for (; node != kNoIndex; node = scene_.nodes[node].parent)
    if (moves(node) && !channels_[node].empty()) return true;
  return false;
}

glm::mat4 NodePoses::localAt(uint32_t node, double time, bool& visible) const {
  const Node& n = scene_.nodes[node];
  const uint32_t mover = moverOfNode_.empty() ? kNoIndex : moverOfNode_[node];
  const bool plays = !channels_.empty() && !channels_[node].empty();
  if (mover == kNoIndex && !plays) return localTransform(n);
  Node moved;
  moved.translation = n.translation, moved.rotation = n.rotation, moved.scale = n.scale;
  bool stands = true;  // no channel moves it; it has channels of weights at most
  for (size_t i = 0; plays && i < channels_[node].size(); ++i) {
    const auto [animation, channel] = channels_[node][i];
    if (channel->path == AnimationChannel::Path::Weights) continue;
    stands = false;
    std::array<float, 4> v{};
    sampleChannel(*channel, animationTime(*animation, time), v);
    if (channel->path == AnimationChannel::Path::Translation) moved.translation = {v[0], v[1], v[2]};
    if (channel->path == AnimationChannel::Path::Scale) moved.scale = {v[0], v[1], v[2]};
    if (channel->path == AnimationChannel::Path::Rotation) moved.rotation = glm::quat(v[3], v[0], v[1], v[2]);
  }
  if (mover == kNoIndex) return stands ? localTransform(n) : localTransform(moved);
  const MotionKey key = poseAt(scene_.movers[mover], time);
  moved.translation = key.translation;
  moved.rotation = key.rotation;
  visible = visible && key.visible;
  return localTransform(moved);
}

NodePoses::Pose NodePoses::at(uint32_t node, double time) const {
  Pose pose;
  for (; node != kNoIndex; node = scene_.nodes[node].parent)
    pose.toWorld = localAt(node, time, pose.visible) * pose.toWorld;
  return pose;
}

std::vector<float> NodePoses::weightsAt(uint32_t node, double time) const {
  std::vector<float> weights = restWeights(scene_, scene_.nodes[node]);
  if (channels_.empty()) return weights;
  for (const auto& [animation, channel] : channels_[node])
    if (channel->path == AnimationChannel::Path::Weights && componentsOf(*channel) <= weights.size())
      sampleChannel(*channel, animationTime(*animation, time), weights);
  return weights;
}

// Joints depend on each other, so the transforms of ancestors are computed once.
void NodePoses::jointsAt(uint32_t node, double time, std::vector<glm::mat4>& joints) const {
  const Skin& skin = scene_.skins[scene_.nodes[node].skin];
  std::unordered_map<uint32_t, glm::mat4> known;
  std::vector<uint32_t> path;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    path.clear();
    uint32_t n = skin.joints[i];
    for (; n != kNoIndex && !known.count(n); n = scene_.nodes[n].parent) path.push_back(n);
    glm::mat4 toWorld = n == kNoIndex ? glm::mat4(1.0f) : known[n];
    bool visible = true;
    for (auto p = path.rbegin(); p != path.rend(); ++p)
      known[*p] = toWorld = toWorld * localAt(*p, time, visible);
    if (path.empty()) toWorld = known[skin.joints[i]];
    joints.push_back(i < skin.inverseBind.size() ? toWorld * skin.inverseBind[i] : toWorld);
  }
}

std::vector<double> NodePoses::sampleTimes(uint32_t node) const {
  std::set<double> keys = {0.0};
  double horizon = 0, period = 0;
  std::set<const Animation*> seen;
  eachAbove(node, [&](uint32_t n) {
    if (const Mover* m =
            moverOfNode_.empty() || moverOfNode_[n] == kNoIndex ? nullptr : &scene_.movers[moverOfNode_[n]]) {
      for (const MotionKey& k : m->keys) keys.insert(k.time);
      horizon = std::max(horizon, double(m->keys.back().time));
    }
    if (channels_.empty()) return;
    for (const auto& [animation, channel] : channels_[n]) {
      for (float t : channel->times) keys.insert(double(t) / animation->speed);
      period = std::max(period, double(duration(*animation)) / animation->speed);
    }
  });
  // The animation repeats until the movers' paths end.
  const std::set<double> once = keys;
  for (double start = period; period > 0 && start < horizon && keys.size() < kMostSamples / kSteps;
       start += period)
    for (double t : once) keys.insert(start + t);
  std::vector<double> times;
  const double stride = std::max(1.0, double(keys.size()) * kSteps / kMostSamples);
  double last = 0, due = 0;
  for (double key : keys) {
    for (int i = 1; i <= kSteps && key > last; ++i)
      if (++due >= stride) times.push_back(last + (key - last) * i / kSteps), due -= stride;
    if (times.empty()) times.push_back(key);
    last = key;
  }
  return times;
}

ObjectPoses objectsAt(const Scene& scene, const Geometry& geometry, double time, double before) {
  ObjectPoses list;
  list.objects.resize(geometry.objects.size());
  const NodePoses poses(scene);
  for (size_t i = 0; i < list.objects.size(); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic) continue;
    const NodePoses::Pose now = poses.at(object.node, time);
    const NodePoses::Pose last = time == before ? now : poses.at(object.node, before);
    const bool invertible = std::abs(glm::determinant(glm::dmat3(now.toWorld))) > 1e-30;
    list.objects[i] = {now.toWorld,
                       last.toWorld,
                       invertible ? glm::mat4(glm::inverse(glm::dmat4(now.toWorld))) : glm::mat4(0),
                       now.visible,
                       last.visible,
                       object.deforms};
    if (object.jointCount > 0 && object.firstJoint == list.joints.size()) {  // else it shares a skin
      poses.jointsAt(object.node, time, list.joints);
      poses.jointsAt(object.node, before, list.previousJoints);
    }
    if (object.weightCount > 0) {
      for (float w : poses.weightsAt(object.node, time)) list.weights.push_back(w);
      for (float w : poses.weightsAt(object.node, before)) list.previousWeights.push_back(w);
    }
  }
  return list;
}

Bounds animatedBounds(const Scene& scene, const NodePoses& poses, const Object& object) {
  const Node& node = scene.nodes[object.node];
  const Mesh& mesh = scene.meshes[node.mesh];
  std::vector<glm::vec3> positions(object.vertexCount), normals(object.vertexCount);
  std::vector<glm::mat4> joints;
  Bounds all, last;
  for (double time : poses.sampleTimes(object.node)) {
    ObjectPose pose;
    pose.toWorld = poses.at(object.node, time).toWorld;
    joints.clear();
    if (object.jointCount > 0) poses.jointsAt(object.node, time, joints);
    const std::vector<float> weights = poses.weightsAt(object.node, time);
    pose.joints = joints;
    pose.weights = weights;
    placeVertices(mesh, object.stencils.get(), pose, positions.data(), normals.data());
    Bounds now;
    for (const glm::vec3& p : positions) now.include(p);
    if (last.low.x <= last.high.x) {
      const glm::vec3 low = 0.25f * glm::abs(now.low - last.low),
                      high = 0.25f * glm::abs(now.high - last.high);
      all.include(now.low - low), all.include(now.high + high);
      all.include(last.low - low), all.include(last.high + high);
    } else {
      all.include(now.low), all.include(now.high);
    }
    last = now;
  }
  return all;
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
    known = 0;  // the speed may jump at a key
    const double first = keys[i].time, length = keys[i + 1].time - first;
    for (int step = 0; step < kSweepSteps; ++step) sample(first + length * step / kSweepSteps);
    sample(first + length * (1 - 1e-9));  // a loop is back at its first key when it reaches the last
  }
  return swept;
}

}  // namespace fovea::scene
