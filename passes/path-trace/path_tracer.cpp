#include "passes/path-trace/path_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "framework/base/random.h"
#include "passes/path-trace/full_integrator.h"
#include "passes/path-trace/path_integrator.h"

namespace fovea::path_trace {
namespace {

using namespace scene;

constexpr uint32_t kPathTraceStream = 0x70617468u;  // keeps the random numbers of this pass apart from others
constexpr uint32_t kScrambles = 16;
constexpr uint32_t kLongestRound = 64;  // samples per pixel
constexpr std::chrono::milliseconds kReportEvery{100};

// Sums over the samples of all pixels.
struct Film {
  std::vector<glm::dvec3> direct, indirect;  // sums
  // Sums of the varying part (radiance less the part that is the same in all samples), one per pixel and slot. Slots
  // are the scrambles or, with independent sampling, the two halves.
  std::vector<glm::vec3> slots;
  std::vector<glm::dvec3> squares;   // independent sampling: sums of the squares of the varying part
  std::vector<uint32_t> rowSamples;  // samples so far of each pixel of the row
};

// Integrator: PathIntegrator or FullIntegrator.
template <class Integrator>
class Tracer {
 public:
  Tracer(const Frame& frame, const View& view, const RayScene& rays, const PathTraceSettings& settings);
  PathTraceStatistics run();
  void write(const PathTraceImages& images) const;

 private:
  void round(uint32_t end);
  void work(bool reports, uint32_t end);
  void traceRow(uint32_t y, uint32_t end);
  void tracePixel(uint32_t x, uint32_t y, uint32_t begin, uint32_t end, uint64_t& rays);
  void addSample(size_t pixel, uint32_t s, glm::vec3 direct, glm::vec3 indirect);
  void report();
  uint32_t nextRow() { return nextRow_.fetch_add(settings_.parts); }
  uint32_t rowsOfPart() const {
    return (view_.size.y + settings_.parts - 1 - settings_.part) / settings_.parts;
  }
  uint32_t samplesInSlot(uint32_t slot, uint32_t samples) const {
    return (samples + slotCount_ - 1 - slot) / slotCount_;
  }
  glm::dvec3 variance(size_t pixel, uint32_t samples) const;
  glm::dvec3 halfMean(size_t pixel, uint32_t samples, uint32_t half) const;

  const View& view_;
  const PathTraceSettings& settings_;
  Integrator integrator_;
  uint32_t samples_, slotCount_, threads_;
  Film film_;
  std::atomic<uint32_t> nextRow_ = 0;
  std::atomic<bool> stop_ = false;
  bool mayStop_ = false;  // set once every pixel has samples
  std::atomic<uint64_t> paths_ = 0, rays_ = 0;
  std::chrono::steady_clock::time_point lastReport_ = std::chrono::steady_clock::now();
};

template <class Integrator>
Tracer<Integrator>::Tracer(const Frame& frame, const View& view, const RayScene& rays,
                           const PathTraceSettings& settings)
    : view_(view),
      settings_(settings),
      integrator_(frame, view, rays, settings.depth),
      samples_(std::max(settings.samples, 2u)),
      slotCount_(settings.independent ? 2 : std::min(kScrambles, samples_ & ~1u)),
      threads_(settings.threads != 0 ? settings.threads : std::max(std::thread::hardware_concurrency(), 1u)) {
  const size_t pixels = size_t(view.size.x) * view.size.y;
  film_.direct.resize(pixels);
  film_.indirect.resize(pixels);
  film_.slots.resize(pixels * slotCount_);
  if (settings.independent) film_.squares.resize(pixels);
  film_.rowSamples.resize(view.size.y);
}

template <class Integrator>
PathTraceStatistics Tracer<Integrator>::run() {
  uint32_t end = 2;
  while (!stop_) {
    round(end);
    mayStop_ = true;
    if (end == samples_) break;
    end = std::min(samples_, end + std::min(end, kLongestRound));
  }
  PathTraceStatistics statistics{paths_, rays_, 0};
  for (const uint32_t n : film_.rowSamples) statistics.samples += double(n);
  statistics.samples /= std::max(double(rowsOfPart()), 1.0);
  return statistics;
}

// Brings every pixel to `end` samples.
template <class Integrator>
void Tracer<Integrator>::round(uint32_t end) {
  nextRow_ = settings_.part;
  std::vector<std::jthread> helpers;
  for (uint32_t i = 1; i < std::min(threads_, view_.size.y); ++i)
    helpers.emplace_back([this, end] { work(false, end); });
  work(true, end);
}

template <class Integrator>
void Tracer<Integrator>::work(bool reports, uint32_t end) {
  for (uint32_t y = nextRow(); y < view_.size.y; y = nextRow()) {
    if (mayStop_ && stop_) return;
    traceRow(y, end);
    if (reports) report();
  }
}

template <class Integrator>
void Tracer<Integrator>::report() {
  const auto now = std::chrono::steady_clock::now();
  if (!settings_.progress || stop_ || now - lastReport_ < kReportEvery) return;
  lastReport_ = now;
  const double total = double(samples_) * view_.size.x * rowsOfPart();
  if (!settings_.progress(double(paths_) / total)) stop_ = true;
}

template <class Integrator>
void Tracer<Integrator>::traceRow(uint32_t y, uint32_t end) {
  const uint32_t begin = film_.rowSamples[y];
  uint64_t rays = 0;
  for (uint32_t x = 0; x < view_.size.x; ++x) tracePixel(x, y, begin, end, rays);
  film_.rowSamples[y] = end;
  paths_ += uint64_t(end - begin) * view_.size.x;
  rays_ += rays;
}

template <class Integrator>
void Tracer<Integrator>::tracePixel(uint32_t x, uint32_t y, uint32_t begin, uint32_t end, uint64_t& rays) {
  const size_t pixel = size_t(y) * view_.size.x + x;
  const uint32_t stream = hashCombine(hashCombine(settings_.seed, kPathTraceStream), uint32_t(pixel));
  const glm::vec2 corner(x, y);
  typename Integrator::EyePoint eye;
  if (!settings_.box) eye = integrator_.look(corner + 0.5f, rays);
  const uint32_t atOnce =
      settings_.box ? 1 : uint32_t(PathIntegrator::kMaxPaths);  // paths per visible point at a time
  std::array<PathSampler, PathIntegrator::kMaxPaths> random;
  std::array<glm::vec3, PathIntegrator::kMaxPaths> indirect;
  for (uint32_t s = begin; s < end;) {
    const uint32_t count = std::min(atOnce, end - s);
    for (uint32_t i = 0; i < count; ++i)
      random[i] = {settings_.independent,
                   hashCombine(stream, settings_.independent ? s + i : (s + i) % slotCount_),
                   (s + i) / slotCount_};
    if (settings_.box) {
      const auto u = random[0].pair(0);
      eye = integrator_.look(corner + glm::vec2(u[0], u[1]), rays);
    }
    std::fill_n(indirect.begin(), count, glm::vec3(0));
    if (eye.surface)
      integrator_.indirect(eye.vertex, std::span(random).first(count), std::span(indirect).first(count),
                           rays);
    for (uint32_t i = 0; i < count; ++i, ++s) addSample(pixel, s, eye.direct, indirect[i]);
  }
}

template <class Integrator>
void Tracer<Integrator>::addSample(size_t pixel, uint32_t s, glm::vec3 direct, glm::vec3 indirect) {
  const glm::vec3 varying = settings_.box ? direct + indirect : indirect;
  film_.direct[pixel] += glm::dvec3(direct);
  film_.indirect[pixel] += glm::dvec3(indirect);
  film_.slots[pixel * slotCount_ + s % slotCount_] += varying;
  if (settings_.independent) film_.squares[pixel] += glm::dvec3(varying) * glm::dvec3(varying);
}

// Variance of the mean over all samples.
template <class Integrator>
glm::dvec3 Tracer<Integrator>::variance(size_t pixel, uint32_t samples) const {
  const glm::vec3* slots = &film_.slots[pixel * slotCount_];
  glm::dvec3 mean(0);
  for (uint32_t i = 0; i < slotCount_; ++i) mean += glm::dvec3(slots[i]) / double(samples);
  if (settings_.independent) {
    const glm::dvec3 square = film_.squares[pixel] / double(samples);
    return glm::max(square - mean * mean, 0.0) / double(samples - 1);
  }
  glm::dvec3 sum(0);
  uint32_t used = 0;
  for (uint32_t i = 0; i < slotCount_; ++i) {
    const uint32_t n = samplesInSlot(i, samples);
    if (n == 0) continue;
    const glm::dvec3 difference = glm::dvec3(slots[i]) / double(n) - mean;
    sum += difference * difference * (double(n) / double(samples));
    ++used;
  }
  return sum / double(used - 1);
}

template <class Integrator>
glm::dvec3 Tracer<Integrator>::halfMean(size_t pixel, uint32_t samples, uint32_t half) const {
  const glm::vec3* slots = &film_.slots[pixel * slotCount_];
  glm::dvec3 sum(0);
  uint32_t count = 0;
  for (uint32_t i = half; i < slotCount_; i += 2) {
    sum += glm::dvec3(slots[i]);
    count += samplesInSlot(i, samples);
  }
  const glm::dvec3 fixed = settings_.box ? glm::dvec3(0) : film_.direct[pixel] / double(samples);
  return fixed + sum / double(count);
}

template <class Integrator>
void Tracer<Integrator>::write(const PathTraceImages& images) const {
  const double unit = double(settings_.unit);
  const auto put = [](std::span<glm::vec4> image, size_t pixel, glm::dvec3 value) {
    if (!image.empty()) image[pixel] = glm::vec4(glm::vec3(value), 1);
  };
  for (size_t pixel = 0; pixel < film_.direct.size(); ++pixel) {
    const uint32_t samples =
        std::max(film_.rowSamples[pixel / view_.size.x], 2u);  // none: another part's row
    const glm::dvec3 direct = film_.direct[pixel] / double(samples),
                     indirect = film_.indirect[pixel] / double(samples);
    put(images.radiance, pixel, unit * (direct + indirect));
    put(images.direct, pixel, unit * direct);
    put(images.indirect, pixel, unit * indirect);
    put(images.variance, pixel, unit * unit * variance(pixel, samples));
    put(images.halfA, pixel, unit * halfMean(pixel, samples, 0));
    put(images.halfB, pixel, unit * halfMean(pixel, samples, 1));
  }
}

}  // namespace

PathTraceStatistics tracePaths(const Frame& frame, const View& view, const RayScene& rays,
                               const PathTraceSettings& settings, const PathTraceImages& images) {
  const auto run = [&](auto&& tracer) {
    const PathTraceStatistics statistics = tracer.run();
    tracer.write(images);
    return statistics;
  };
  if (settings.full) return run(Tracer<FullIntegrator>(frame, view, rays, settings));
  return run(Tracer<PathIntegrator>(frame, view, rays, settings));
}

}  // namespace fovea::path_trace
