// Compares path tracing with its rays alone: records the rays that the pass path-trace casts for a picture and traces
// them again with nothing else. Usage: path_trace_benchmark [scene [side [samples [repetitions]]]]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <ctime>
#include <thread>
#include <vector>

#include "fovea/error.h"
#include "fovea/scene.h"
#include "fovea/scenes.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/path_integrator.h"
#include "passes/path-trace/path_tracer.h"

namespace {

using namespace fovea;
using path_trace::PathIntegrator;

// Wall time, and time for which the process ran on a core; the latter is the one to compare on a machine
// with other users.
struct Seconds {
  double wall = 0, cpu = 0;
};

double now(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class Work>
Seconds measure(const Work& work) {
  const double wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
  work();
  return {now(CLOCK_MONOTONIC) - wall, now(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

// As tracePaths() casts them: rounds of 2, 2, 4, 8 ... 64 samples over the picture, with a new eye ray in each.
std::vector<PathIntegrator::TracedRay> recordRays(const scene::Frame& frame, const scene::RayScene& rays,
                                                  uint32_t samples) {
  const scene::View& view = frame.views[0];
  std::vector<PathIntegrator::TracedRay> recorded;
  PathIntegrator integrator(frame, view, rays, 4);
  integrator.record(&recorded);
  uint64_t count = 0;
  for (uint32_t begin = 0, end = 2; begin < samples;
       begin = end, end = std::min(samples, end + std::min(end, 64u)))
    for (uint32_t y = 0; y < view.size.y; ++y)
      for (uint32_t x = 0; x < view.size.x; ++x) {
        const path_trace::EyePoint eye = integrator.look(glm::vec2(x, y) + 0.5f, count);
        for (uint32_t s = begin; eye.surface && s < end;) {
          std::array<path_trace::PathSampler, PathIntegrator::kMaxPaths> random;
          std::array<glm::vec3, PathIntegrator::kMaxPaths> light{};
          const uint32_t atOnce = std::min(end - s, uint32_t(random.size()));
          for (uint32_t i = 0; i < atOnce; ++i, ++s)
            random[i] = {false, hashCombine(y * view.size.x + x, s % 16), s / 16};
          integrator.indirect(eye.vertex, std::span(random).first(atOnce), light, count);
        }
      }
  return recorded;
}

double traceAlone(const scene::RayScene& rays, const std::vector<PathIntegrator::TracedRay>& recorded) {
  constexpr size_t kChunk = 4096;
  std::atomic<size_t> next = 0;
  std::atomic<uint64_t> found = 0;
  const auto work = [&] {
    uint64_t hits = 0;
    for (size_t first = next.fetch_add(kChunk); first < recorded.size(); first = next.fetch_add(kChunk))
      for (size_t i = first; i < std::min(first + kChunk, recorded.size()); ++i) {
        const auto& r = recorded[i];
        hits += r.shadow ? uint64_t(rays.occluded(r.ray)) : uint64_t(rays.intersect(r.ray).triangle & 1u);
      }
    found += hits;
  };
  {
    std::vector<std::jthread> helpers;
    for (uint32_t i = 1; i < std::thread::hardware_concurrency(); ++i) helpers.emplace_back(work);
    work();
  }
  return double(found);
}

int run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "sponza";
  const auto number = [&](int i, uint32_t otherwise) {
    return argc > i ? uint32_t(std::atoi(argv[i])) : otherwise;
  };
  const uint32_t side = std::max(number(2, 64), 1u), samples = std::max(number(3, 2000), 2u);
  Diagnostics warnings;
  const scene::Scene s = scene::load(name, warnings);
  const scene::Geometry geometry = scene::flatten(s);
  const scene::Frame frame = scene::makeFrame(s, geometry, {side, side}, 0, 1);
  const auto rays = scene::RayScene::cached(s, geometry);
  // A sixteenth of the samples: representative, and few enough to keep.
  const auto recorded = recordRays(frame, *rays, std::max(samples / 16, 2u));
  std::vector<double> ratios, cpuRatios;
  fmt::print("{}, {}x{}, {} samples a pixel, depth 4, {} threads; {} rays recorded\n", name, side, side,
             samples, std::thread::hardware_concurrency(), recorded.size());
  for (uint32_t i = 0; i < std::max(number(4, 3), 1u); ++i) {
    path_trace::PathTraceSettings settings;
    settings.samples = samples;
    std::vector<glm::vec4> radiance(size_t(side) * side);
    path_trace::PathTraceStatistics statistics;
    // Traces the rays alone before and after, because the speed of a shared machine changes from second to second.
    const Seconds before = measure([&] { traceAlone(*rays, recorded); });
    const Seconds paths = measure([&] {
      statistics = tracePaths(frame, frame.views[0], *rays, settings, {radiance, {}, {}, {}, {}, {}});
    });
    const Seconds after = measure([&] { traceAlone(*rays, recorded); });
    const Seconds alone{before.wall + after.wall, before.cpu + after.cpu};
    const double aloneRays = 2 * double(recorded.size()), scale = double(statistics.rays) / aloneRays;
    ratios.push_back(alone.wall * scale / paths.wall);
    cpuRatios.push_back(alone.cpu * scale / paths.cpu);
    fmt::print(
        "  {:.3f} M paths/s, {:.2f} M rays/s; rays alone {:.2f} M/s; ratio {:.3f} by the clock, {:.3f} by "
        "processor time "
        "({:.0f} ns a ray)\n",
        1e-6 * double(statistics.paths) / paths.wall, 1e-6 * double(statistics.rays) / paths.wall,
        1e-6 * aloneRays / alone.wall, ratios.back(), cpuRatios.back(), 1e9 * alone.cpu / aloneRays);
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + long(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  fmt::print("median of the ratio: {:.3f} by the clock, {:.3f} by processor time\n", median(ratios),
             median(cpuRatios));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  fovea::scenes::registerAll();
  try {
    return run(argc, argv);
  } catch (const fovea::Error& e) {
    fmt::print(stderr, "path_trace_benchmark: {}\n", e.what());
    return int(e.code());
  }
}
