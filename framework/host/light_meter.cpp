// The light meter of first views, by kernels that run on the host.
#include "framework/scene/first_view/light_meter.h"

#include <array>
#include <map>
#include <string>

#include "fovea/error.h"
#include "framework/graph/run/host_kernel.h"
#include "framework/scene/host/host_scene.h"

namespace fovea::host {
namespace {

using namespace scene;

template <class T>
graph::HostResource resourceOf(std::span<T> list) {
  return {
      {reinterpret_cast<std::byte*>(const_cast<std::remove_const_t<T>*>(list.data())), list.size_bytes()}};
}

// Runs a kernel over the first view of a frame.
void run(const char* shader, const Frame& frame, std::array<uint32_t, 2> threads,
         std::array<uint32_t, 3> groupSize, std::span<const std::byte> constants,
         const std::map<std::string, graph::HostResource, std::less<>>& ports) {
  const graph::HostKernel kernel = graph::findHostKernel(shader, {{"RAY_PASSAGE", "1"}});
  if (!kernel) throw Error(ExitCode::Internal, std::string("no kernel ") + shader + " for the host");
  HostScene scene(*frame.scene, *frame.geometry, true);
  scene.update(frame);
  graph::HostDispatch dispatch;
  dispatch.scene = &scene;
  dispatch.groups = {(threads[0] + groupSize[0] - 1) / groupSize[0],
                     (threads[1] + groupSize[1] - 1) / groupSize[1], 1};
  dispatch.groupSize = groupSize;
  dispatch.constants = constants;
  dispatch.port = [&](std::string_view name) { return ports.find(name)->second; };
  kernel(dispatch);
}

class KernelMeter : public LightMeter {
 public:
  std::vector<MeterPoint> picture(const Frame& frame) const override {
    const glm::uvec2 size = frame.views.front().size;
    std::vector<MeterPoint> points(size_t(size.x) * size.y);
    run("scene/light_meter.comp", frame, {size.x, size.y}, {8, 8, 1}, {},
        {{"points", resourceOf(std::span(points))}});
    for (MeterPoint& point : points) {
      point.radiance /= frame.preExposure;
      point.arriving /= frame.preExposure;
      point.emitted /= frame.preExposure;
    }
    return points;
  }

  std::vector<glm::vec4> sharesFrom(const Frame& frame, std::span<const MeterPoint> points,
                                    glm::vec3 direction) const override {
    std::vector<glm::vec4> shares(points.size());
    const glm::vec4 towards(direction, 0);
    run("scene/light_meter_sun.comp", frame, {uint32_t(points.size()), 1}, {64, 1, 1},
        std::as_bytes(std::span(&towards, 1)),
        {{"points", resourceOf(points)}, {"shares", resourceOf(std::span(shares))}});
    return shares;
  }
};

const KernelMeter meter;
[[maybe_unused]] const bool known = (setLightMeter(meter), true);

}  // namespace
}  // namespace fovea::host
