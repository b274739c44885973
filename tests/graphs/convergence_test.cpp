// Compares instant radiosity with the path tracer: with more and more VPLs both give the same picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 48;
constexpr uint32_t kAtOnce = 1024;  // VPLs in a frame; more of them are the mean of several frames

scene::Scene offAxisCornellBox() {
  scene::Scene s = scene::builtin("cornellbox");
  // The camera is off the axis, where pixel centres would fall exactly on the seams of the room, which the maps of
  // the VPLs leave dark.
  s.cameras[0].position += glm::vec3(0.037f, 0.021f, 0);
  return s;
}

using Image = std::vector<float>;  // RGBA

struct Reference {
  Image indirect, variance;
};

// Mean of (a - g)^2 / (g + 0.01)^2, less what the noise of the reference adds to it, and the ratio of the means.
struct Difference {
  double relMse = 0, ratio = 0;
};

Difference compare(const Image& a, const Reference& g) {
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

void add(Image& sum, const Image& image, size_t share) {
  sum.resize(image.size());
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += image[i] / float(share);
}

struct Effort {
  uint32_t samples;        // a pixel of the reference
  uint32_t mapSize;        // of the VPLs, texels
  uint32_t floorPictures;  // of the largest number of VPLs, at least 2
  uint32_t pictures(uint32_t count) const {
    return count > kAtOnce ? floorPictures : std::clamp(2048 / count, 4u, 8u);
  }
};

// Errors of pictures of `count` VPLs each. A picture with more than kAtOnce VPLs is the mean of frames whose discs
// are as small as if all VPLs were in one frame.
struct Measured {
  double relMse = 0;     // mean over the pictures
  double remaining = 0;  // of the mean of all pictures, less its noise: what more pictures do not reduce
  double ratio = 0;      // of the mean of all pictures
};

Measured measure(const scene::Scene& s, const Reference& reference, uint32_t count, const Effort& effort) {
  const uint32_t frames = (count + kAtOnce - 1) / kAtOnce, pictures = effort.pictures(count);
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = frames * pictures;
  options.everyFrame = true;
  options.set = {"vpl_count=" + std::to_string(count / frames),
                 "emit.averaged_frames=" + std::to_string(frames),
                 "kernel=disc",
                 "interleave=1",
                 "bounces=1",
                 "map_size=" + std::to_string(effort.mapSize),
                 "atlas_layout=tiled",
                 "shadow_map_size=256"};
  const GraphRun run = runGraph("ir_1000", s, options);
  Image all;
  double error = 0;
  for (uint32_t p = 0; p < pictures; ++p) {
    Image picture;
    for (uint32_t f = 0; f < frames; ++f)
      add(picture, toFloats(run.frames[p * frames + f].outputs.at("indirect")), frames);
    error += compare(picture, reference).relMse / pictures;
    add(all, picture, pictures);
  }
  const Difference mean = compare(all, reference);
  // error = bias + noise, mean.relMse = bias + noise / pictures.
  return {error, (pictures * mean.relMse - error) / (pictures - 1), mean.ratio};
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

// One VPL bounce corresponds to paths of depth 3. The VPLs come from random light paths, use the disc kernel (no
// clamp), and each of them lights every pixel.
//
// Most of the error is not noise but light that the kernel removes near a VPL, within the radius of the disc that it
// stands for, whose area is 1 / N of the lit surface. Where two walls meet, this is up to all of the light that one
// sends to the other, in a strip as wide as the discs' radius. There the error falls as N^-1/2 only until the strip
// is thinner than a pixel, and this makes up the floor at 4096 VPLs (with discs a hundredth as large a fifth of it is
// left, in the few pixels on the seams themselves). VPLs that are spread over several frames need discs as small as
// if they were in one frame; otherwise the floor is that of the VPLs of one frame.
void expectOneOverN(const Effort& effort) {
  const scene::Scene s = offAxisCornellBox();
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.set = {"depth=3", "spp=" + std::to_string(effort.samples)};
  const GraphRun traced = runGraph("reference", s, options);
  const Reference reference{toFloats(traced.outputs.at("indirect")), toFloats(traced.outputs.at("variance"))};
  std::vector<double> x, y;
  Measured last;
  for (const uint32_t count : {64u, 128u, 256u, 512u, 1024u, 4096u}) {
    last = measure(s, reference, count, effort);
    std::printf(
        "  %4u VPLs, %2u pictures: relMSE %.5f, %.5f in the mean of infinitely many; mean %.4f of the "
        "reference's\n",
        count, effort.pictures(count), last.relMse, last.remaining, last.ratio);
    x.push_back(double(count));
    y.push_back(last.relMse);
  }
  EXPECT_LT(y.back(), 0.0035);
  EXPECT_NEAR(last.ratio, 1, 0.02);
  // The decrease is tested down to the floor: errors well above it as they are, and all errors less the floor.
  const double floor = last.remaining;
  const size_t above = size_t(std::count_if(y.begin(), y.end(), [&](double e) { return e > 3 * floor; }));
  ASSERT_GE(above, 4u);
  const double all = slopeOf(x, y);
  std::vector<double> rest = y;
  for (double& error : rest) error -= floor;
  const double lessFloor = slopeOf(x, rest);
  x.resize(above), y.resize(above);
  const double aboveFloor = slopeOf(x, y);
  std::printf("  floor %.5f; slope %.3f over all, %.3f up to %.0f VPLs, %.3f less the floor\n", floor, all,
              aboveFloor, x.back(), lessFloor);
  for (const double slope : {aboveFloor, lessFloor}) {
    EXPECT_GE(slope, -1.25);
    EXPECT_LE(slope, -0.75);
  }
}

TEST(LongConvergence, RelativeErrorOfInstantRadiosityFallsAsOneOverTheVpls) {
  expectOneOverN({.samples = 4096, .mapSize = 128, .floorPictures = 2});
}

// Runs only with --gtest_also_run_disabled_tests and takes minutes. 1024 maps of 512 x 512 texels take 1 GiB.
TEST(LongConvergence, DISABLED_TheSameWithLargeMapsAndAFloorOfSixteenPictures) {
  expectOneOverN({.samples = 16384, .mapSize = 512, .floorPictures = 16});
}

}  // namespace
}  // namespace fovea::test
