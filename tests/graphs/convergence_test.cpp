// Instant radiosity against the path tracer: with ever more VPLs it becomes the same picture.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "framework/scene/load.h"
#include "tests/support/pass_test.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 48;

scene::Scene offAxisCornellBox() {
  scene::Scene s = scene::builtin("cornellbox");
  // On the axis pixel centres fall exactly on the seams of the room, which the maps of the VPLs leave dark.
  s.cameras[0].position += glm::vec3(0.037f, 0.021f, 0);
  return s;
}

struct Reference {
  std::vector<float> indirect, variance;
};

// Mean of (a - g)^2 / (g + 0.01)^2 less what the reference's noise adds to it; and the ratio of the means.
struct Difference {
  double relMse = 0, ratio = 0;
};

Difference compare(const std::vector<float>& a, const Reference& g) {
  Difference d;
  double sumA = 0, sumG = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (i % 4 == 3) continue;
    const double weight = 1 / std::pow(g.indirect[i] + 0.01, 2) / (3.0 * kSide * kSide);
    d.relMse += (std::pow(double(a[i]) - g.indirect[i], 2) - g.variance[i]) * weight;
    sumA += a[i];
    sumG += g.indirect[i];
  }
  d.ratio = sumA / sumG;
  return d;
}

std::vector<float> meanOf(const std::vector<graph::FrameResult>& frames) {
  std::vector<float> mean(size_t(kSide) * kSide * 4);
  for (const auto& frame : frames) {
    const std::vector<float> image = toFloats(frame.outputs.at("indirect"));
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += image[i] / float(frames.size());
  }
  return mean;
}

double slopeOf(const std::vector<double>& x, const std::vector<double>& y) {
  double meanX = 0, meanY = 0, xy = 0, xx = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    meanX += std::log(x[i]) / double(x.size());
    meanY += std::log(y[i]) / double(x.size());
  }
  for (size_t i = 0; i < x.size(); ++i) {
    xy += (std::log(x[i]) - meanX) * (std::log(y[i]) - meanY);
    xx += std::pow(std::log(x[i]) - meanX, 2);
  }
  return xy / xx;
}

// One VPL bounce is what paths of depth 3 carry. Random light paths, disc kernel (no clamp), every VPL for
// every pixel. The kernel takes light away near a VPL while its area, 1 / N of the surface, is large: 16% in
// all with 64 VPLs, 1% with 4096; that error falls at least as fast as the variance. What does not fall is
// where surfaces touch (the foot of the cube, the room's edges): the maps of the VPLs leave pixels dark
// there. That floor is what is left in the mean of two frames of 4096. Maps of 128 x 128: with 512 x 512 4096
// VPLs would need 4 GiB.
TEST(Convergence, RelativeErrorOfInstantRadiosityFallsAsOneOverTheVpls) {
  const scene::Scene s = offAxisCornellBox();
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.set = {"depth=3", "spp=512"};
  const GraphRun traced = runGraph("reference", s, options);
  const Reference reference{toFloats(traced.outputs.at("indirect")), toFloats(traced.outputs.at("variance"))};
  std::vector<double> x, y;
  Difference floor;
  for (const uint32_t count : {64u, 128u, 256u, 512u, 1024u, 4096u}) {
    options.frames = count <= 256 ? 4 : 2;
    options.everyFrame = true;
    options.set = {"vpl_count=" + std::to_string(count),
                   "kernel=disc",
                   "interleave=1",
                   "bounces=1",
                   "map_size=128",
                   "atlas_layout=tiled",
                   "shadow_map_size=256"};
    const GraphRun run = runGraph("ir_1000", s, options);
    double error = 0;
    for (const auto& frame : run.frames)
      error += compare(toFloats(frame.outputs.at("indirect")), reference).relMse / double(run.frames.size());
    floor = compare(meanOf(run.frames), reference);
    std::printf("  %4u VPLs: relMSE %.5f, mean %.4f of the reference's\n", count, error, floor.ratio);
    x.push_back(double(count));
    y.push_back(error);
  }
  EXPECT_LT(y.back(), 0.003);
  EXPECT_NEAR(floor.ratio, 1, 0.02);
  std::printf("  slope %.3f over all", slopeOf(x, y));
  x.pop_back();
  y.pop_back();
  for (double& error : y) error -= floor.relMse;
  const double slope = slopeOf(x, y);
  std::printf(", %.3f up to 1024 down to the floor of %.5f\n", slope, floor.relMse);
  EXPECT_GE(slope, -1.25);
  EXPECT_LE(slope, -0.75);
}

}  // namespace
}  // namespace fovea::test
