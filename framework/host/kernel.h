// Compiles a kernel of a pass for the host. The source file of a kernel (framework/cmake/host_kernels.cmake makes one for
// each) includes this header and then, inside of a struct that derives from Kernel, the shader: what is global in GLSL is
// a member there. GLM provides the functions and types of GLSL.
#pragma once

#include <atomic>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/integer.hpp>
#include <mutex>
#include <span>
#include <type_traits>

#include "fovea/error.h"
#include "framework/base/threads.h"
#include "framework/host/copy_state.h"
#include "framework/host/images.h"
#include "framework/scene/host/host_scene.h"
// All records that kernels know; those of namespaces cannot be included inside of a struct.
#include "shaders/records/contact.h"
#include "shaders/records/emitters.h"
#include "shaders/records/eye_paths.h"
#include "shaders/records/fovea.h"
#include "shaders/records/gather_cache.h"
#include "shaders/records/hemisphere_rays.h"
#include "shaders/records/light_meter.h"
#include "shaders/records/light_paths.h"
#include "shaders/records/mirror.h"
#include "shaders/records/near_field.h"
#include "shaders/records/paraboloid.h"
#include "shaders/records/probes.h"
#include "shaders/records/rays.h"
#include "shaders/records/reservoir.h"
#include "shaders/records/scene.h"
#include "shaders/records/vpl.h"

namespace fovea::host {

using namespace glm;
using namespace fovea::scene;
using namespace fovea::passes;
using std::uint32_t;

inline uint atomicAdd(uint& memory, uint value) { return std::atomic_ref(memory).fetch_add(value); }
inline uint atomicMax(uint& memory, uint value) {
  std::atomic_ref<uint> reference(memory);
  uint before = reference.load();
  while (before < value && !reference.compare_exchange_weak(before, value)) {
  }
  return before;
}
inline uint atomicCompSwap(uint& memory, uint expected, uint value) {
  std::atomic_ref(memory).compare_exchange_strong(expected, value);
  return expected;
}

// What every kernel finds: the scene's tables (shaders/scene/tables.glsl), rays, and the ports of its pass.
class Kernel {
 public:
  // passing: what rays do at surfaces that let light through.
  Kernel(const graph::HostDispatch& dispatch, Passing passing)
      : frame(dispatch.scene->frame()),
        view(dispatch.scene->view(dispatch.view)),
        lights(dispatch.scene->lights()),
        sceneMaterials(dispatch.scene->materials()),
        rayEmitters(dispatch.scene->emitters()),
        gl_WorkGroupSize(dispatch.groupSize[0], dispatch.groupSize[1], dispatch.groupSize[2]),
        gl_NumWorkGroups(dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]),
        dispatch_(dispatch),
        scene_(*dispatch.scene),
        geometry_(dispatch.scene->geometry()),
        rays_(dispatch.scene->rays(passing)) {}

  uvec3 gl_GlobalInvocationID{0};

 protected:
  const FrameBlock& frame;
  const ViewBlock& view;
  const LightRecord* lights;
  const vec4* sceneMaterials;
  const uvec4* rayEmitters;
  const uvec3 gl_WorkGroupSize, gl_NumWorkGroups;

  uvec4 sceneTriangle(uint triangle) const {
    const Triangle& t = geometry_.triangles[triangle];
    return {t.v[0], t.v[1], t.v[2], t.materialAndObject};
  }
  const vec3& scenePosition(uint vertex) const { return geometry_.positions[vertex]; }
  const vec3& sceneNormal(uint vertex) const { return geometry_.normals[vertex]; }
  const vec2& sceneUv(uint vertex) const { return geometry_.uvs[vertex]; }
  float sceneAlpha(uint vertex) const { return geometry_.colors.empty() ? 1.0f : geometry_.colors[vertex].a; }
  vec4 sceneTexel(ivec3 p, bool linear) const { return scene_.texel(p, linear); }
  ivec2 environmentSize() const { return scene_.environmentSize(); }
  vec3 environmentTexel(ivec2 p) const { return scene_.environmentTexel(p); }

  void traceOnHost(vec3 origin, vec3 direction, float near, float far, bool any, uint& triangle,
                   float& distance, vec2& weights) const {
    const fovea::scene::Ray ray{origin, direction, near, far};
    if (any) {
      if (rays_.occluded(ray)) triangle = 0;
      return;
    }
    const fovea::scene::RayHit hit = rays_.intersect(ray);
    if (!hit) return;
    triangle = hit.triangle;
    distance = hit.distance;
    weights = {hit.u, hit.v};
  }

  // The port to which a member of the kernel is bound.
  template <class T>
  T port(const char* name) const {
    return T(dispatch_.port(name));
  }

 private:
  const graph::HostDispatch& dispatch_;
  const HostScene& scene_;
  const Geometry& geometry_;
  const RayScene& rays_;
};

// The state of a kernel that each invocation must find as it was at first: all of it but its base class, which no
// shader changes, and its counters, which add up.
template <class K>
class State {
 public:
  explicit State(K& kernel) : kernel_(kernel), first_(kernel) {
    if constexpr (requires { kernel.counters; }) {
      const auto* start = reinterpret_cast<const std::byte*>(&kernel);
      counters_ = size_t(reinterpret_cast<const std::byte*>(&kernel.counters) - start);
      behind_ = counters_ + sizeof kernel.counters;
    }
  }
  void restore() {
    copy(sizeof(Kernel), counters_);
    copy(behind_, sizeof(K));
  }

 private:
  void copy(size_t from, size_t to) {
    if (from < to)
      copyState(reinterpret_cast<std::byte*>(&kernel_) + from, reinterpret_cast<std::byte*>(&first_) + from,
                to - from);
  }
  K &kernel_, first_;
  size_t counters_ = sizeof(Kernel), behind_ = sizeof(Kernel);
};

// The counters of a kernel, all of which are 32-bit integers.
template <class K>
void addCounters(const K& kernel, std::span<uint64_t> sums) {
  if constexpr (requires { kernel.counters; }) {
    uint32_t counted[sizeof(kernel.counters) / sizeof(uint32_t)];
    std::memcpy(counted, &kernel.counters, sizeof counted);
    for (size_t i = 0; i < std::min(std::size(counted), sums.size()); ++i) sums[i] += counted[i];
  }
}

// Calls main() for each invocation, as a device does: with what is global to the shader as it was at first.
template <class K>
void runKernel(const graph::HostDispatch& dispatch, Passing passing) {
  static_assert(std::is_trivially_copyable_v<K>);
  K first(dispatch, passing);
  if constexpr (requires { first.constants; }) {
    if (!dispatch.constants.empty() && sizeof first.constants != dispatch.constants.size())
      throw Error(ExitCode::Internal,
                  "the push constants of a kernel have gaps, which the host does not have",
                  "put vectors before scalars");
    std::memcpy(&first.constants, dispatch.constants.data(), dispatch.constants.size());
  }
  if constexpr (requires { first.counters; }) std::memset(&first.counters, 0, sizeof first.counters);
  const uvec3 groups(dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
  const uvec3 size(dispatch.groupSize[0], dispatch.groupSize[1], dispatch.groupSize[2]);
  const uint32_t all = groups.x * groups.y * groups.z;
  std::atomic<uint32_t> next = 0;
  std::mutex mutex;
  onThreads(std::min(threadCount(0), all), [&] {
    K kernel(first);
    State<K> state(kernel);
    for (uint32_t group = next++; group < all; group = next++) {
      const uvec3 at(group % groups.x, group / groups.x % groups.y, group / groups.x / groups.y);
      for (uint z = 0; z < size.z; ++z)
        for (uint y = 0; y < size.y; ++y)
          for (uint x = 0; x < size.x; ++x) {
            state.restore();
            kernel.gl_GlobalInvocationID = at * size + uvec3(x, y, z);
            kernel.main();
          }
    }
    const std::scoped_lock lock(mutex);
    addCounters(kernel, dispatch.counters);
  });
}

}  // namespace fovea::host

// This turns the qualifiers of GLSL into macros, so that only shaders can follow.
#include "shaders/device/language.h"
