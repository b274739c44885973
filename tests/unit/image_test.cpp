#include "fovea/image.h"
#include "framework/image/header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "fovea/error.h"
#include "framework/base/random.h"

namespace fovea::image {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ImageFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("fovea-" + std::string(info->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  size_t filesInFolder() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

Image noise(uint32_t width, uint32_t height, uint32_t channels, uint32_t seed) {
  Image image{width, height, channels, std::vector<float>(size_t(width) * height * channels)};
  for (uint32_t i = 0; i < image.data.size(); ++i)
    image.data[i] = 100 * (uniformFloat(hashCombine(seed, i)) - 0.25f);
  return image;
}

void expectSameBits(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels, b.channels);
  for (size_t i = 0; i < a.data.size(); ++i) {
    if (std::isnan(a.data[i]))
      EXPECT_TRUE(std::isnan(b.data[i])) << "value " << i;
    else
      ASSERT_EQ(std::bit_cast<uint32_t>(a.data[i]), std::bit_cast<uint32_t>(b.data[i])) << "value " << i;
  }
}

template <class F>
void expectError(ExitCode code, const std::vector<std::string>& words, F&& f) {
  try {
    f();
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(code)) << e.what();
    for (const std::string& word : words) EXPECT_THAT(std::string(e.what()), HasSubstr(word));
  }
}

TEST_F(ImageFiles, ExrKeepsLayersBitsAndMetadata) {
  const fs::path file = folder_ / "layers.exr";
  std::vector<Layer> layers{{"radiance", noise(37, 21, 4, 1)},
                            {"indirect", noise(37, 21, 3, 2)},
                            {"gbuffer.depth", noise(37, 21, 1, 3)}};
  layers[1].image.at(36, 20, 2) = std::numeric_limits<float>::quiet_NaN();
  layers[1].image.at(0, 1, 0) = -std::numeric_limits<float>::infinity();
  layers[2].image.at(5, 5, 0) = 1e-40f;  // a denormal
  Metadata metadata{{"graph", "ir_1000"},
                    {"scene", "caf\xc3\xa9, \"quoted\""},
                    {"size", "37x21"},
                    {"seed", "7"},
                    {"note", ""}};
  write(file, layers, metadata);
  const File back = read(file);
  ASSERT_EQ(back.layers.size(), 3u);
  for (const Layer& layer : layers) {
    ASSERT_NE(back.find(layer.name), nullptr) << layer.name;
    expectSameBits(layer.image, *back.find(layer.name));
  }
  EXPECT_EQ(back.find("direct"), nullptr);
  metadata.erase("note");  // empty entries are left out
  EXPECT_EQ(back.metadata, metadata);
  EXPECT_EQ(filesInFolder(), 1u);  // no temporary file stays
}

TEST_F(ImageFiles, ExrWithManyChannelsInOneLayerKeepsTheirOrder) {
  const fs::path file = folder_ / "many.exr";
  const Image image = noise(4, 3, 12, 5);
  write(file, {{"weights", image}});
  expectSameBits(image, *read(file).find("weights"));
}

TEST_F(ImageFiles, PlainExrLayerHasNoName) {
  const fs::path file = folder_ / "plain.exr";
  const Image image = noise(8, 8, 3, 6);
  write(file, {{"", image}});
  ASSERT_NE(read(file).find(""), nullptr);
  expectSameBits(image, *read(file).find(""));
}

TEST_F(ImageFiles, PfmRoundTrip) {
  for (uint32_t channels : {1u, 3u}) {
    const fs::path file = folder_ / "a.pfm";
    const Image image = noise(13, 7, channels, channels);
    write(file, {{"", image}});
    expectSameBits(image, read(file).layers.at(0).image);
  }
}

TEST_F(ImageFiles, PngRoundsToEightBitsAndKeepsMetadata) {
  const Metadata metadata{{"graph", "direct"}, {"gaze", "0.5,0.5"}};
  for (uint32_t channels = 1; channels <= 4; ++channels) {
    const fs::path file = folder_ / ("c" + std::to_string(channels) + ".png");
    Image image{16, 16, channels, std::vector<float>(16 * 16 * channels)};
    for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = (float(i % 256) + 0.3f) / 255;
    image.data[0] = -1;
    image.data[channels] = 2;
    write(file, {{"image", image}}, metadata);
    const File back = read(file);
    ASSERT_EQ(back.layers.size(), 1u);
    const Image& found = back.layers[0].image;
    ASSERT_EQ(found.channels, channels);
    EXPECT_EQ(back.metadata, metadata);
    EXPECT_EQ(found.data[0], 0);
    EXPECT_EQ(found.data[channels], 1);
    for (size_t i = channels + 1; i < image.data.size(); ++i)
      ASSERT_NEAR(found.data[i] * 255, float(i % 256), 1e-3)
          << "value " << i << ", " << channels << " channels";
  }
}

TEST_F(ImageFiles, PngShowsNanAsMagenta) {
  const fs::path file = folder_ / "nan.png";
  Image image{2, 1, 3, {0.2f, std::nanf(""), 0.4f, 0, 0, std::numeric_limits<float>::infinity()}};
  write(file, {{"", image}});
  EXPECT_THAT(read(file).layers.at(0).image.data, testing::ElementsAre(1, 0, 1, 0, 0, 1));
}

TEST_F(ImageFiles, EightBitTexturesComeBackAsStored) {
  const fs::path file = folder_ / "t.png";
  // Colour under low alpha must survive: textures are not premultiplied.
  write(file, {{"", Image{2, 1, 4, {200 / 255.f, 100 / 255.f, 50 / 255.f, 3 / 255.f, 1, 0, 0, 0}}}});
  const Image8 image = read8(file);
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(image.height, 1u);
  EXPECT_THAT(image.rgba, testing::ElementsAre(200, 100, 50, 3, 255, 0, 0, 0));
  write(file, {{"", Image{1, 1, 1, {77 / 255.f}}}});
  EXPECT_THAT(read8(file).rgba, testing::ElementsAre(77, 77, 77, 255));
}

// One block of one colour (200, 100, 50).
TEST_F(ImageFiles, JpegInMemory) {
  static constexpr uint8_t kJpeg[] = {
      0xff, 0xd8, 0xff, 0xe0, 0x00, 0x10, 0x4a, 0x46, 0x49, 0x46, 0x00, 0x01, 0x01, 0x00, 0x00, 0x01, 0x00,
      0x01, 0x00, 0x00, 0xff, 0xdb, 0x00, 0x43, 0x00, 0x03, 0x02, 0x02, 0x03, 0x02, 0x02, 0x03, 0x03, 0x03,
      0x03, 0x04, 0x03, 0x03, 0x04, 0x05, 0x08, 0x05, 0x05, 0x04, 0x04, 0x05, 0x0a, 0x07, 0x07, 0x06, 0x08,
      0x0c, 0x0a, 0x0c, 0x0c, 0x0b, 0x0a, 0x0b, 0x0b, 0x0d, 0x0e, 0x12, 0x10, 0x0d, 0x0e, 0x11, 0x0e, 0x0b,
      0x0b, 0x10, 0x16, 0x10, 0x11, 0x13, 0x14, 0x15, 0x15, 0x15, 0x0c, 0x0f, 0x17, 0x18, 0x16, 0x14, 0x18,
      0x12, 0x14, 0x15, 0x14, 0xff, 0xdb, 0x00, 0x43, 0x01, 0x03, 0x04, 0x04, 0x05, 0x04, 0x05, 0x09, 0x05,
      0x05, 0x09, 0x14, 0x0d, 0x0b, 0x0d, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14,
      0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14,
      0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14, 0x14,
      0x14, 0x14, 0x14, 0x14, 0x14, 0xff, 0xc0, 0x00, 0x11, 0x08, 0x00, 0x08, 0x00, 0x08, 0x03, 0x01, 0x22,
      0x00, 0x02, 0x11, 0x01, 0x03, 0x11, 0x01, 0xff, 0xc4, 0x00, 0x1f, 0x00, 0x00, 0x01, 0x05, 0x01, 0x01,
      0x01, 0x01, 0x01, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05,
      0x06, 0x07, 0x08, 0x09, 0x0a, 0x0b, 0xff, 0xc4, 0x00, 0xb5, 0x10, 0x00, 0x02, 0x01, 0x03, 0x03, 0x02,
      0x04, 0x03, 0x05, 0x05, 0x04, 0x04, 0x00, 0x00, 0x01, 0x7d, 0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05,
      0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61, 0x07, 0x22, 0x71, 0x14, 0x32, 0x81, 0x91, 0xa1, 0x08,
      0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52, 0xd1, 0xf0, 0x24, 0x33, 0x62, 0x72, 0x82, 0x09, 0x0a, 0x16, 0x17,
      0x18, 0x19, 0x1a, 0x25, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43,
      0x44, 0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64,
      0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x83, 0x84, 0x85,
      0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4,
      0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3,
      0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe1,
      0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8, 0xe9, 0xea, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8,
      0xf9, 0xfa, 0xff, 0xc4, 0x00, 0x1f, 0x01, 0x00, 0x03, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01,
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x09, 0x0a,
      0x0b, 0xff, 0xc4, 0x00, 0xb5, 0x11, 0x00, 0x02, 0x01, 0x02, 0x04, 0x04, 0x03, 0x04, 0x07, 0x05, 0x04,
      0x04, 0x00, 0x01, 0x02, 0x77, 0x00, 0x01, 0x02, 0x03, 0x11, 0x04, 0x05, 0x21, 0x31, 0x06, 0x12, 0x41,
      0x51, 0x07, 0x61, 0x71, 0x13, 0x22, 0x32, 0x81, 0x08, 0x14, 0x42, 0x91, 0xa1, 0xb1, 0xc1, 0x09, 0x23,
      0x33, 0x52, 0xf0, 0x15, 0x62, 0x72, 0xd1, 0x0a, 0x16, 0x24, 0x34, 0xe1, 0x25, 0xf1, 0x17, 0x18, 0x19,
      0x1a, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45, 0x46, 0x47,
      0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64, 0x65, 0x66, 0x67, 0x68,
      0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88,
      0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7,
      0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6,
      0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe2, 0xe3, 0xe4, 0xe5,
      0xe6, 0xe7, 0xe8, 0xe9, 0xea, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa, 0xff, 0xda, 0x00,
      0x0c, 0x03, 0x01, 0x00, 0x02, 0x11, 0x03, 0x11, 0x00, 0x3f, 0x00, 0xa9, 0x45, 0x14, 0x57, 0xe1, 0xe7,
      0xf4, 0x81, 0xff, 0xd9,
  };
  const Image8 image = decode8(kJpeg, sizeof(kJpeg), "orange.jpg");
  ASSERT_EQ(image.width, 8u);
  ASSERT_EQ(image.height, 8u);
  for (size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(image.rgba[i * 4], 200, 3);
    EXPECT_NEAR(image.rgba[i * 4 + 1], 100, 3);
    EXPECT_NEAR(image.rgba[i * 4 + 2], 50, 3);
    EXPECT_EQ(image.rgba[i * 4 + 3], 255);
  }
  expectError(ExitCode::BadInput, {"cut.jpg"}, [&] { decode8(kJpeg, 40, "cut.jpg"); });
  // Decoders skip what is between two segments, and so does the check of what a header claims.
  std::vector<uint8_t> padded(std::begin(kJpeg), std::end(kJpeg));
  const std::vector<uint8_t> junk = {0, 7, 0xff, 0, 0xff, 0xd3, 0xff, 0xff};
  padded.insert(padded.begin() + 20, junk.begin(), junk.end());
  ASSERT_TRUE(headerSize(padded));
  EXPECT_EQ(headerSize(padded)->width, image.width);
  EXPECT_EQ(decode8(padded.data(), padded.size(), "padded.jpg").rgba, image.rgba);
}

TEST_F(ImageFiles, BrokenFilesAreNamed) {
  auto put = [&](const char* name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  };
  const fs::path png = folder_ / "whole.png";
  write(png, {{"", noise(32, 32, 3, 1)}});
  std::ifstream stream(png, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  expectError(ExitCode::BadInput, {"half.png"},
              [&] { read8(put("half.png", bytes.substr(0, bytes.size() / 2))); });
  expectError(ExitCode::BadInput, {"text.png", "neither PNG nor JPEG"},
              [&] { read8(put("text.png", "hello")); });
  expectError(ExitCode::BadInput, {"empty.png", "empty"}, [&] { read8(put("empty.png", "")); });
  expectError(ExitCode::BadInput, {"no.exr"}, [&] { read(put("no.exr", "no exr at all")); });
  expectError(ExitCode::BadInput, {"no.pfm"}, [&] { read(put("no.pfm", "PF\n100 100\n-1.0\nshort")); });
  expectError(ExitCode::BadInput, {"absent.png", "No such file"}, [&] { read(folder_ / "absent.png"); });
  expectError(ExitCode::BadInput, {"it is a folder"}, [&] { read(folder_); });
}

TEST_F(ImageFiles, WhatCannotBeWrittenSaysWhy) {
  const std::vector<Layer> one{{"", noise(4, 4, 3, 1)}};
  expectError(ExitCode::BadInput, {"a.webp", ".exr", ".png", ".pfm"},
              [&] { write(folder_ / "a.webp", one); });
  expectError(ExitCode::BadInput, {"no extension"}, [&] { checkWritable(folder_ / "a"); });
  expectError(ExitCode::CannotWrite, {"a.png", "missing", "does not exist"},
              [&] { checkWritable(folder_ / "missing/a.png"); });
  expectError(ExitCode::CannotWrite, {"/proc/a.png"}, [&] { write("/proc/a.png", one); });
  fs::create_directory(folder_ / "dir.png");
  expectError(ExitCode::CannotWrite, {"dir.png", "it is a folder"}, [&] { write(folder_ / "dir.png", one); });
  const std::vector<Layer> two{{"a", noise(4, 4, 3, 1)}, {"b", noise(4, 4, 3, 1)}};
  expectError(ExitCode::BadInput, {"one layer"}, [&] { write(folder_ / "a.png", two); });
  expectError(ExitCode::BadInput, {"`b`", "differs in size", "`a`"}, [&] {
    write(folder_ / "a.exr", {{"a", noise(4, 4, 3, 1)}, {"b", noise(4, 5, 3, 1)}});
  });
  expectError(ExitCode::BadInput, {"there twice"}, [&] {
    write(folder_ / "a.exr", {{"a", noise(4, 4, 3, 1)}, {"a", noise(4, 4, 3, 1)}});
  });
  expectError(ExitCode::BadInput, {"5 channels"}, [&] {
    write(folder_ / "a.png", {{"", noise(4, 4, 5, 1)}});
  });
  EXPECT_EQ(filesInFolder(), 1u);  // only dir.png
}

// A file-size limit stands in for a full disk; without it small files would be reported as written.
TEST_F(ImageFiles, AnExistingFileSurvivesAFailedWrite) {
  for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
    const fs::path file = folder_ / name;
    write(file, {{"", Image{2, 1, 3, {0, 0, 0, 1, 1, 1}}}});
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    for (rlim_t bytes : {rlim_t(0), rlim_t(100), rlim_t(1000)}) {
      const rlimit small{bytes, limit.rlim_max};
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
      try {
        write(file, {{"", noise(64, 64, 3, 9)}});
        ADD_FAILURE() << name << " was reported as written into " << bytes << " bytes";
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::CannotWrite) << e.what();
        EXPECT_THAT(std::string(e.what()), HasSubstr(name));
      }
      setrlimit(RLIMIT_FSIZE, &limit);
      EXPECT_THAT(read(file).layers.at(0).image.data, testing::ElementsAre(0, 0, 0, 1, 1, 1));
    }
    signal(SIGXFSZ, handler);
  }
  EXPECT_EQ(filesInFolder(), 3u);
}

TEST(Colors, SrgbMatchesTheStandard) {
  EXPECT_FLOAT_EQ(srgbEncode(0), 0);
  EXPECT_FLOAT_EQ(srgbEncode(1), 1);
  EXPECT_FLOAT_EQ(srgbEncode(0.002f), 0.02584f);
  EXPECT_NEAR(srgbEncode(0.18f), 0.46135613, 1e-6);
  EXPECT_NEAR(srgbDecode(128 / 255.f), 0.21586050, 1e-6);
  EXPECT_EQ(srgbEncode(-3), 0);
  EXPECT_EQ(srgbDecode(7), 1);
  for (int i = 0; i < 256; ++i)
    EXPECT_NEAR(srgbEncode(srgbDecode(float(i) / 255)), float(i) / 255, 1e-6) << i;
}

std::string littleEndian(uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += char(value >> 8 * i & 0xff);
  return bytes;
}

// An EXR header with one attribute that claims `size` bytes and has these; `flags` are those of its version field.
std::string exrHeader(const std::string& type, uint32_t size, const std::string& value, uint32_t flags = 0) {
  using namespace std::string_literals;
  return "\x76\x2f\x31\x01"s + littleEndian(2 | flags) + "thing"s + '\0' + type + '\0' + littleEndian(size) +
         value + '\0';
}

std::string exrAttribute(const std::string& name, const std::string& value) {
  return name + '\0' + "any" + '\0' + littleEndian(uint32_t(value.size())) + value;
}

// An EXR header of a picture with so many channels of 32 bits; `more` are further attributes.
std::string exrPicture(uint32_t width, uint32_t height, size_t channels, char compression,
                       const std::string& more = "", uint32_t flags = 0) {
  std::string list;
  for (size_t c = 0; c < channels; ++c)
    list += "c" + std::string(1, '\0') + littleEndian(2) + std::string(12, '\0');
  return "\x76\x2f\x31\x01" + littleEndian(2 | flags) + exrAttribute("channels", list + '\0') +
         exrAttribute("compression", std::string(1, compression)) +
         exrAttribute("dataWindow", littleEndian(0) + littleEndian(0) + littleEndian(width - 1) +
                                        littleEndian(height - 1)) +
         more + '\0';
}

// OpenEXR reserves memory for whole blocks as it opens a file.
TEST(ImageHeaders, HugeBlocksOfExrPixelsAreFound) {
  const auto forged = [](const std::string& bytes) {
    std::istringstream stream(bytes);
    return whyForged(stream);
  };
  constexpr char kNone = 0, kZip = 3, kDwab = 9;
  EXPECT_EQ(forged(exrPicture(8192, 32768, 4, kDwab)), "");
  EXPECT_THAT(forged(exrPicture(8192, 1, 5, kDwab)), HasSubstr("claims 40 MiB of at most 32"));
  EXPECT_EQ(forged(exrPicture(32768, 1, 16, kZip)), "");
  EXPECT_NE(forged(exrPicture(32768, 1, 17, kZip)), "");
  EXPECT_EQ(forged(exrPicture(32768, 1, 256, kNone)), "");
  const auto tiles = [](uint32_t side) {
    return exrAttribute("tiles", littleEndian(side) + littleEndian(side) + std::string(1, '\0'));
  };
  constexpr uint32_t kTiled = 0x200, kParts = 0x1000;
  EXPECT_EQ(forged(exrPicture(64, 64, 4, kZip, tiles(1024), kTiled)), "");
  EXPECT_NE(forged(exrPicture(64, 64, 4, kZip, tiles(2048), kTiled)), "");
  EXPECT_NE(forged(exrPicture(64, 64, 4, kZip, tiles(0xffffffff), kTiled)), "");
  // A file without tiles may have the attribute all the same.
  EXPECT_NE(forged(exrPicture(32768, 1, 5, kDwab, tiles(1))), "");
  EXPECT_EQ(forged(exrPicture(32768, 1, 5, kDwab, tiles(1), kTiled)), "");
  const auto part = [&](const char* type) { return exrAttribute("type", type) + tiles(1); };
  EXPECT_NE(forged(exrPicture(32768, 1, 5, kDwab, part("scanlineimage"), kParts)), "");
  EXPECT_EQ(forged(exrPicture(32768, 1, 5, kDwab, part("tiledimage"), kParts)), "");
}

// Sizes that fit are left to OpenEXR, in files that are cut short as well.
TEST(ImageHeaders, ForgedSizesOfExrAttributesAreFound) {
  const auto forged = [](const std::string& bytes) {
    std::istringstream stream(bytes);
    return whyForged(stream);
  };
  const std::string eight(8, 'x');
  EXPECT_EQ(forged(exrHeader("string", 8, eight)), "");
  EXPECT_THAT(forged(exrHeader("string", 10, eight)), HasSubstr("`thing` has another size"));
  EXPECT_NE(forged(exrHeader("string", 0xffffffff, eight)), "");
  const std::string preview = littleEndian(2) + littleEndian(1) + eight;
  EXPECT_EQ(forged(exrHeader("int", 4, "four")), "");
  EXPECT_NE(forged(exrHeader("int", 8, eight)), "");
  const std::string channel = "c" + std::string(1, '\0') + eight + eight;
  EXPECT_EQ(forged(exrHeader("chlist", 19, channel + '\0')), "");
  EXPECT_NE(forged(exrHeader("chlist", 20, channel + '\0' + "x")),
            "");  // OpenEXR goes on behind the empty name
  EXPECT_EQ(forged(exrHeader("preview", 16, preview)), "");
  EXPECT_NE(forged(exrHeader("preview", 15, preview)), "");
  EXPECT_NE(forged(exrHeader("preview", 16, littleEndian(1u << 31) + littleEndian(1u << 31) + eight)), "");
  const std::string words = littleEndian(3) + "one" + littleEndian(0) + littleEndian(4) + "four";
  EXPECT_EQ(forged(exrHeader("stringvector", 19, words)), "");
  EXPECT_NE(forged(exrHeader("stringvector", 19, words.substr(0, 11) + littleEndian(5) + "four")), "");
  EXPECT_NE(forged(exrHeader("stringvector", 17, words + "....")), "");
  const auto window = [&](uint32_t first, uint32_t last) {
    std::string bytes =
        exrHeader("box2i", 16, littleEndian(first) + littleEndian(0) + littleEndian(last) + littleEndian(1));
    return forged(bytes.replace(bytes.find("thing"), 5, "dataWindow"));
  };
  EXPECT_EQ(window(-5, 32762), "");
  EXPECT_THAT(window(-5, 32763), HasSubstr("longer than any picture"));
  EXPECT_NE(window(0x80000000, 0x7fffffff), "");
  // OpenImageIO aborts at channels whose values have an unknown type.
  const auto channelOf = [](uint32_t type) {
    const std::string list = std::string("c") + '\0' + littleEndian(type) + std::string(12, '\0') + '\0';
    std::string bytes = exrHeader("chlist", uint32_t(list.size()), list);
    return bytes.replace(bytes.find("thing"), 5, "channels");
  };
  for (const uint32_t type : {0u, 1u, 2u}) EXPECT_EQ(forged(channelOf(type)), "");
  for (const uint32_t type : {3u, 0xffffff02u})
    EXPECT_THAT(forged(channelOf(type)), HasSubstr("channel `c` has values of an unknown type"));
  // A second part.
  const std::string second = exrHeader("string", 100, eight).substr(8);
  EXPECT_EQ(forged(exrHeader("string", 8, eight) + second), "");
  EXPECT_NE(forged(exrHeader("string", 8, eight, 0x1000) + second), "");
  const std::string whole = exrHeader("stringvector", 19, words, 0x1000);
  for (size_t length = 0; length < whole.size(); ++length) forged(whole.substr(0, length));
}

}  // namespace
}  // namespace fovea::image
