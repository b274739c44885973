// Builds animations: keys of nodes and of morph weights.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/motion/animation.h"
#include "framework/scene/motion/deform.h"

namespace fovea::scene::gltf {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

class AnimationBuilder {
 public:
  AnimationBuilder(Context& c, size_t index)
      : c_(c), from_(c.model.animations[index]), place_(nameOf("animations", index, from_.name)) {
    out_.name = from_.name.empty() ? "animation " + std::to_string(index) : from_.name;
  }

  Animation build() {
    for (size_t i = 0; i < from_.channels.size(); ++i)
      channel(from_.channels[i], place_ + ".channels[" + std::to_string(i) + "]");
    return std::move(out_);
  }

 private:
  void channel(const tinygltf::AnimationChannel& from, const std::string& place) {
    if (from.target_node < 0) return;  // glTF 2.0, 3.11: to be ignored
    AnimationChannel channel;
    channel.node = c_.sceneNode[size_t(from.target_node)];
    if (channel.node == kNoIndex) return;
    if (!pathOf(from.target_path, channel.path))
      return c_.warn(place, "`" + from.target_path.substr(0, 32) + "` of a node cannot be animated: ignored");
    const Node& node = c_.scene.nodes[channel.node];
    if (channel.path != Path::Weights && node.matrix)
      return c_.warn(place, "node `" + node.name + "` has a matrix, which keys cannot move: ignored",
                     "export it with translation, rotation and scale");
    if (!seen_.insert({channel.node, channel.path}).second)
      return c_.warn(place, "another channel moves the same property of node `" + node.name + "`: ignored");
    const tinygltf::AnimationSampler& sampler = from_.samplers.at(size_t(from.sampler));
    const std::string at = place_ + ".samplers[" + std::to_string(from.sampler) + "]";
    channel.interpolation = sampler.interpolation == "STEP"          ? Interpolation::Step
                            : sampler.interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                                                                     : Interpolation::Linear;
    readTimes(sampler.input, at, channel);
    if (!readValues(sampler.output, at, node, channel)) return;
    out_.channels.push_back(std::move(channel));
  }

  static bool pathOf(const std::string& name, Path& path) {
    const std::pair<const char*, Path> paths[] = {{"translation", Path::Translation},
                                                  {"rotation", Path::Rotation},
                                                  {"scale", Path::Scale},
                                                  {"weights", Path::Weights}};
    for (const auto& [known, value] : paths)
      if (name == known) {
        path = value;
        return true;
      }
    return false;
  }

  void readTimes(int accessor, const std::string& at, AnimationChannel& channel) {
    const std::string path = at + ".input, accessors[" + std::to_string(accessor) + "]";
    channel.times = readFloats(c_, accessor, 1, path);
    if (channel.times.empty()) c_.fail(path, "an animation without keys");
    float last = -1;
    for (size_t i = 0; i < channel.times.size(); ++i) {
      const float t = channel.times[i];
      if (!std::isfinite(t) || t < 0)
        c_.fail(path, "the time of key " + std::to_string(i) + " is negative or not finite");
      if (t <= last)
        c_.fail(path, "the time of key " + std::to_string(i) + " is not after that of the key before it");
      last = t;
    }
  }

  // Returns false if there is nothing to move.
  bool readValues(int accessor, const std::string& at, const Node& node, AnimationChannel& channel) {
    const std::string path = at + ".output, accessors[" + std::to_string(accessor) + "]";
    size_t components = channel.path == Path::Rotation ? 4 : 3;
    if (channel.path == Path::Weights) {
      const Mesh* mesh = node.mesh == kNoIndex ? nullptr : &c_.scene.meshes[node.mesh];
      components = mesh ? morphTargets(*mesh) : 0;
      if (components == 0) {
        c_.warn(path, "node `" + node.name + "` has no morph targets: its weights are ignored");
        return false;
      }
    }
    channel.values = readFloats(c_, accessor, channel.path == Path::Weights ? 1 : int(components), path);
    const size_t groups = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
    const size_t expected = channel.times.size() * groups * components;
    if (channel.values.size() != expected)
      c_.fail(path, std::to_string(channel.values.size()) + " numbers; " +
                        std::to_string(channel.times.size()) + " keys need " + std::to_string(expected));
    for (size_t i = 0; i < channel.values.size(); ++i)
      if (!std::isfinite(channel.values[i])) c_.fail(path, "number " + std::to_string(i) + " is not finite");
    if (channel.path == Path::Rotation) normalize(path, groups, channel);
    return true;
  }

  // Applies to the keys of rotations, not to the tangents of splines.
  void normalize(const std::string& path, size_t groups, AnimationChannel& channel) {
    for (size_t key = 0; key < channel.times.size(); ++key) {
      float* q = &channel.values[4 * (key * groups + (groups == 3 ? 1 : 0))];
      const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      if (!(length > 1e-6f)) c_.fail(path, "the rotation of key " + std::to_string(key) + " is zero");
      for (int i = 0; i < 4; ++i) q[i] /= length;
    }
  }

  Context& c_;
  const tinygltf::Animation& from_;
  std::string place_;
  Animation out_;
  std::set<std::pair<uint32_t, Path>> seen_;
};

}  // namespace

void buildAnimations(Context& c) {
  for (size_t i = 0; i < c.model.animations.size(); ++i)
    c.scene.animations.push_back(AnimationBuilder(c, i).build());
  if (!c.scene.animations.empty()) c.scene.animations[0].plays = true;
}

}  // namespace fovea::scene::gltf
