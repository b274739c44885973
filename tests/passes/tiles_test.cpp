// Tests full-screen steps that draw only the tiles of a mask: what they write, and what happens to the rest.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "fovea/error.h"
#include "fovea/test.h"

namespace fovea::test {
namespace {

namespace fs = std::filesystem;

// A pass whose step writes x, y and 1 into one image and 7 into another.
const char* const kPlaces = R"json({
  "doc": "writes the place of each pixel",
  "inputs": { "size": { "doc": "gives the size", "format": "r8" },
              "tiles": { "doc": "tiles to draw", "format": "r8", "usage": ["storage_read"], "optional": true } },
  "outputs": { "place": { "doc": "x, y, 1", "format": "rgba32f", "width": "size.width", "height": "size.height" },
               "seven": { "doc": "7", "format": "r32ui", "width": "size.width", "height": "size.height" } },
  "steps": [{ "shader": "places.frag", "colors": ["place", "seven"], "tiles": "tiles" }]
})json";

// The same for tiles of 8 x 8 pixels that the pass itself chooses: those of the input that are not 0.
const char* const kChosen = R"json({
  "doc": "writes the place of each pixel in tiles that it chooses",
  "inputs": { "size": { "doc": "gives the size", "format": "r8" },
              "chosen": { "doc": "tiles", "format": "r8", "usage": ["storage_read"] } },
  "outputs": { "place": { "doc": "x, y, 1", "format": "rgba32f", "width": "size.width", "height": "size.height" },
               "seven": { "doc": "7", "format": "r32ui", "width": "size.width", "height": "size.height" } },
  "scratch": { "own_tiles": { "doc": "tiles to draw", "format": "r8",
                              "width": "size.width / 8", "height": "size.height / 8" } },
  "steps": [{ "shader": "choose.frag", "colors": ["own_tiles"] },
            { "shader": "places.frag", "colors": ["place", "seven"], "tiles": "own_tiles" }]
})json";

// Writes 7 into all of an image, and 9 into some tiles of it.
const char* const kOverdrawn = R"json({
  "doc": "writes one number over another",
  "inputs": { "size": { "doc": "gives the size", "format": "r8" },
              "tiles": { "doc": "tiles to draw", "format": "r8", "usage": ["storage_read"] } },
  "outputs": { "number": { "doc": "7 or 9", "format": "r32ui", "width": "size.width", "height": "size.height" } },
  "steps": [{ "name": "all", "shader": "number.frag", "colors": ["number"], "define": { "NUMBER": 7 } },
            { "name": "some", "shader": "number.frag", "colors": ["number"], "define": { "NUMBER": 9 },
              "tiles": "tiles" }]
})json";

class Tiles : public testing::Test {
 protected:
  Tiles() {
    const fs::path folder = fs::path(testing::TempDir()) / "tile_passes";
    fs::create_directories(folder);
    std::ofstream(folder / "test-places.pass.json") << kPlaces;
    std::ofstream(folder / "test-chosen-places.pass.json") << kChosen;
    std::ofstream(folder / "test-overdrawn.pass.json") << kOverdrawn;
    std::ofstream(folder / "number.frag") << R"(
layout(location = 0) out uint number;
void main() { number = uint(NUMBER); }
)";
    std::ofstream(folder / "places.frag") << R"(
layout(location = 0) out vec4 place;
layout(location = 1) out uint seven;
void main() {
  place = vec4(floor(gl_FragCoord.xy), 1.0, 0.0);
  seven = 7u;
}
)";
    std::ofstream(folder / "choose.frag") << R"(
layout(r8) uniform readonly image2D chosen;
layout(location = 0) out float ownTiles;
void main() { ownTiles = imageLoad(chosen, ivec2(gl_FragCoord.xy)).r; }
)";
    graph::addPasses(folder);
  }
};

struct Size {
  uint32_t width, height;
  Size tiles(uint32_t tile) const { return {(width + tile - 1) / tile, (height + tile - 1) / tile}; }
};

using Mask = std::vector<uint8_t>;

Mask masked(Size tiles, uint32_t every) {
  Mask mask(size_t(tiles.width) * tiles.height);
  for (size_t i = 0; i < mask.size(); i += every) mask[i] = 255;
  return mask;
}

void wire(PassTest& test, Size size, const std::string& port, Size tiles, const Mask& mask) {
  test.image("size", VK_FORMAT_R8_UNORM, size.width, size.height, 1, Mask(size_t(size.width) * size.height));
  test.image(port, VK_FORMAT_R8_UNORM, tiles.width, tiles.height, 1, mask);
}

// Expects the place of each pixel of a tile in the mask, and 0 everywhere else.
void expectPlaces(const PassTest& test, Size size, uint32_t tile, const Mask& mask) {
  const auto place = test.values<std::array<float, 4>>("place");
  const auto seven = test.values<uint32_t>("seven");
  ASSERT_EQ(place.size(), size_t(size.width) * size.height);
  for (uint32_t i = 0; i < place.size(); ++i) {
    const uint32_t x = i % size.width, y = i / size.width;
    const bool drawn = mask[size_t(y / tile) * size.tiles(tile).width + x / tile] != 0;
    const std::array<float, 4> want{drawn ? float(x) : 0, drawn ? float(y) : 0, drawn ? 1.0f : 0, 0};
    ASSERT_EQ(place[i], want) << x << " " << y << ", tiles of " << tile;
    ASSERT_EQ(seven[i], drawn ? 7u : 0u) << x << " " << y << ", tiles of " << tile;
  }
}

TEST_F(Tiles, OnlyThoseOfTheMaskAreDrawn) {
  for (const Size size : {Size{64, 48}, Size{61, 35}, Size{7, 200}, Size{1, 1}})
    for (const uint32_t tile : {1u, 2u, 8u, 16u, 32u})
      for (const uint32_t every : {1u, 3u, 1000000u}) {
        const Mask mask = masked(size.tiles(tile), every);
        PassTest test("test-places");
        wire(test, size, "tiles", size.tiles(tile), mask);
        test.run();
        expectPlaces(test, size, tile, mask);
      }
}

// What earlier frames have drawn is gone.
TEST_F(Tiles, NothingIsLeftWhereTheMaskIsEmpty) {
  const Size size{40, 24};
  const Mask all = masked(size.tiles(8), 1), none(all.size());
  PassTest test("test-places");
  wire(test, size, "tiles", size.tiles(8), all);
  test.run();
  test.set("tiles", none);
  test.run();
  expectPlaces(test, size, 8, none);
}

TEST_F(Tiles, WhatAnEarlierStepHasWrittenStays) {
  const Size size{61, 35};
  const Mask mask = masked(size.tiles(16), 3);
  PassTest test("test-overdrawn");
  wire(test, size, "tiles", size.tiles(16), mask);
  test.run();
  const auto number = test.values<uint32_t>("number");
  for (uint32_t i = 0; i < number.size(); ++i) {
    const uint32_t x = i % size.width, y = i / size.width;
    ASSERT_EQ(number[i], mask[size_t(y / 16) * size.tiles(16).width + x / 16] != 0 ? 9u : 7u)
        << x << " " << y;
  }
}

TEST_F(Tiles, WithoutAMaskEverythingIsDrawn) {
  const Size size{40, 24};
  PassTest test("test-places");
  test.image("size", VK_FORMAT_R8_UNORM, size.width, size.height, 1, Mask(size_t(size.width) * size.height));
  test.run();
  expectPlaces(test, size, 8, masked(size.tiles(8), 1));
}

// The mask is complete before its tiles are drawn, in every frame.
TEST_F(Tiles, AStepBeforeMayMakeTheMask) {
  const Size size{61, 35};
  Mask mask = masked(size.tiles(8), 3);
  PassTest test("test-chosen-places");
  wire(test, size, "chosen", size.tiles(8), mask);
  test.run();
  expectPlaces(test, size, 8, mask);
  for (uint8_t& tile : mask) tile = uint8_t(255 - tile);
  test.set("chosen", mask);
  test.run();
  expectPlaces(test, size, 8, mask);
}

TEST_F(Tiles, AMaskOfAnotherImageIsRefused) {
  PassTest test("test-places");
  wire(test, {512, 512}, "tiles", {52, 32}, Mask(size_t(52 * 32)));  // tiles of 10 x 16 pixels
  try {
    test.run();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::BadInput);
    const std::string text = error.what();
    EXPECT_NE(text.find("(test-places), step `places`: `tiles` has 52x32 texels for images of 512x512"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("divided by 8, 16 or 32"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace fovea::test
