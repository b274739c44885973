// Builds animations: keys of nodes and of morph weights.
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
  AnimationBuilder(Context& c, size_t index) : c_(c), from_(itemsOf(&c.root, "animations")[index]) {
    const std::string name = textOr(&from_, "name", "");
    place_ = nameOf("animations", index, name);
    out_.name = name.empty() ? "animation " + std::to_string(index) : name;
  }

  // One that is wrong keeps its number, without channels.
  Animation build() {
    const auto channels = [&] {
      const std::vector<json::Value>& list = itemsOf(&from_, "channels");
      for (size_t i = 0; i < list.size(); ++i)
        channel(list[i], place_ + ".channels[" + std::to_string(i) + "]");
    };
    if (!c_.attempt(channels, "the animation is left out")) out_.channels.clear();
    return std::move(out_);
  }

 private:
  void channel(const json::Value& from, const std::string& place) {
    const json::Value* target = from.find("target");
    const int moved = indexIn(target, "node");
    if (moved < 0) return;  // glTF 2.0, 3.11: to be ignored
    AnimationChannel channel;
    channel.node = c_.sceneNode[size_t(moved)];
    if (channel.node == kNoIndex) return;
    const std::string path = textOr(target, "path", "");
    if (!pathOf(path, channel.path))
      return c_.warn(place, "`" + path.substr(0, 32) + "` of a node cannot be animated: ignored");
    const Node& node = c_.scene.nodes[channel.node];
    if (channel.path != Path::Weights && node.matrix)
      return c_.warn(place, "node `" + node.name + "` has a matrix, which keys cannot move: ignored",
                     "export it with translation, rotation and scale");
    if (!seen_.insert({channel.node, channel.path}).second)
      return c_.warn(place, "another channel moves the same property of node `" + node.name + "`: ignored");
    const int number = indexIn(&from, "sampler");
    const json::Value& sampler = itemsOf(&from_, "samplers").at(size_t(number));
    const std::string at = place_ + ".samplers[" + std::to_string(number) + "]",
                      interpolation = textOr(&sampler, "interpolation", "LINEAR");
    channel.interpolation = interpolation == "STEP"          ? Interpolation::Step
                            : interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                                                             : Interpolation::Linear;
    readTimes(indexIn(&sampler, "input"), at, channel);
    if (!readValues(indexIn(&sampler, "output"), at, node, channel)) return;
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
  const json::Value& from_;
  std::string place_;
  Animation out_;
  std::set<std::pair<uint32_t, Path>> seen_;
};

}  // namespace

void buildAnimations(Context& c) {
  for (size_t i = 0; i < itemsOf(&c.root, "animations").size(); ++i)
    c.scene.animations.push_back(AnimationBuilder(c, i).build());
  const auto moves =
      std::ranges::find_if(c.scene.animations, [](const Animation& a) { return !a.channels.empty(); });
  if (moves != c.scene.animations.end()) moves->plays = true;
}

}  // namespace fovea::scene::gltf
