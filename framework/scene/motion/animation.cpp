#include "framework/scene/motion/animation.h"

#include <algorithm>
#include <cmath>

namespace fovea::scene {
namespace {

using Interpolation = AnimationChannel::Interpolation;
using Path = AnimationChannel::Path;

glm::quat quaternion(const float* v) { return {v[3], v[0], v[1], v[2]}; }

void store(const glm::quat& q, std::span<float> value) {
  value[0] = q.x, value[1] = q.y, value[2] = q.z, value[3] = q.w;
}

glm::quat unit(const glm::quat& q) {
  const float length = glm::length(q);
  return length > 1e-12f ? q / length : glm::quat(1, 0, 0, 0);
}

// Hermite spline between two keys that lie `span` seconds apart; k and l are their first floats.
float cubic(const float* k, const float* l, size_t components, size_t i, float span, float u) {
  const float u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * k[components + i] + span * (u3 - 2 * u2 + u) * k[2 * components + i] +
         (3 * u2 - 2 * u3) * l[components + i] + span * (u3 - u2) * l[i];
}

}  // namespace

float duration(const Animation& animation) {
  float last = 0;
  for (const AnimationChannel& c : animation.channels)
    if (!c.times.empty()) last = std::max(last, c.times.back());
  return last;
}

float animationTime(const Animation& animation, double time) {
  const double length = duration(animation), t = time * animation.speed;
  if (animation.repeat == Repeat::Once || length <= 0) return float(t);
  const double period = animation.repeat == Repeat::Loop ? length : 2 * length;
  const double within = t - std::floor(t / period) * period;
  return float(within > length ? period - within : within);
}

size_t componentsOf(const AnimationChannel& channel) {
  const size_t keys = channel.times.size();
  if (keys == 0) return 0;
  const size_t groups = channel.interpolation == Interpolation::CubicSpline ? 3 * keys : keys;
  const size_t components = channel.values.size() / groups;
  const size_t expected = channel.path == Path::Weights ? components : channel.path == Path::Rotation ? 4 : 3;
  return channel.values.size() == groups * components && components == expected ? components : 0;
}

void sampleChannel(const AnimationChannel& channel, float time, std::span<float> value) {
  const size_t n = componentsOf(channel);
  if (n == 0 || value.size() < n) return;
  const std::vector<float>& times = channel.times;
  const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  const bool holds = next == 0 || next == times.size() || channel.interpolation == Interpolation::Step;
  const bool isCubic = channel.interpolation == Interpolation::CubicSpline;
  const size_t stride = isCubic ? 3 * n : n;
  const float* k = &channel.values[stride * (next == 0 ? 0 : next - 1)];
  const bool turns = channel.path == Path::Rotation;
  if (holds) {
    std::copy_n(k + (isCubic ? n : 0), n, value.begin());
    if (turns) store(unit(quaternion(value.data())), value);
    return;
  }
  const float* l = k + stride;
  const float span = times[next] - times[next - 1], u = (time - times[next - 1]) / span;
  if (isCubic) {
    for (size_t i = 0; i < n; ++i) value[i] = cubic(k, l, n, i, span, u);
    if (turns) store(unit(quaternion(value.data())), value);
  } else if (turns) {
    store(unit(glm::slerp(unit(quaternion(k)), unit(quaternion(l)), u)), value);
  } else {
    for (size_t i = 0; i < n; ++i) value[i] = k[i] + u * (l[i] - k[i]);
  }
}

}  // namespace fovea::scene
