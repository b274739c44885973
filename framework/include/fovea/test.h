// The test kit. It runs one pass alone: inputs are uploaded from arrays, the pass is executed through the real compiler and
// executor, and its outputs are read back. Validation layers are on. It works with any test framework, since what fails
// is thrown.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fovea/graph.h"
#include "fovea/pass.h"
#include "fovea/scene.h"

namespace fovea::test {

class PassTest {
 public:
  explicit PassTest(std::string type);
  ~PassTest();

  PassTest& param(const std::string& name, bool value);
  PassTest& param(const std::string& name, int value);
  PassTest& param(const std::string& name, double value);
  PassTest& param(const std::string& name, const char* value);
  PassTest& viewSize(uint32_t width, uint32_t height);
  PassTest& scene(scene::Scene scene);  // default: empty, with a default camera
  PassTest& seed(uint32_t seed);
  // Called before every frame: to move things, cut the camera, or change an input with
  // setImage()/setBuffer().
  PassTest& beforeFrame(std::function<void(PassTest&, scene::Frame&)> hook);

  // `port` is "radiance", or "gbuffer.position" for a member of a bundle. Texels tightly packed, layer after
  // layer (or slice after slice).
  template <class T>
  PassTest& image(const std::string& port, VkFormat format, uint32_t width, uint32_t height, uint32_t layers,
                  const std::vector<T>& texels) {
    return imageBytes(port, format, width, height, layers, false, toBytes(texels));
  }
  template <class T>
  PassTest& volume(const std::string& port, VkFormat format, uint32_t width, uint32_t height, uint32_t depth,
                   const std::vector<T>& texels, uint32_t mips = 1) {  // mip after mip
    return imageBytes(port, format, width, height, depth, true, toBytes(texels), mips);
  }
  template <class T>
  PassTest& buffer(const std::string& port, const std::vector<T>& values, const std::string& element) {
    return bufferBytes(port, element, sizeof(T), values.size(), toBytes(values));
  }
  // Another content of the same size, from the next frame on.
  template <class T>
  void set(const std::string& port, const std::vector<T>& values) {
    setBytes(port, toBytes(values));
  }

  // Builds the graph on first use, runs `frames` frames and reads all outputs of the last one. Throws Error(BadInput) on
  // inputs that do not fit the declaration, std::runtime_error on a message of the validation layers.
  void run(uint32_t frames = 1);

  const std::vector<std::byte>& bytes(const std::string& port) const;
  const graph::ResourceDesc& desc(const std::string& port) const;
  template <class T>
  std::vector<T> values(const std::string& port) const {
    const auto& raw = bytes(port);
    std::vector<T> result(raw.size() / sizeof(T));
    std::memcpy(result.data(), raw.data(), result.size() * sizeof(T));
    return result;
  }
  // Image texels as floats, channels interleaved (half, unorm, snorm and float formats; unorm to [0, 1]).
  std::vector<float> floats(const std::string& port) const;
  double counter(const std::string& name) const;
  const graph::PassDeclaration& declaration() const;
  double gpuMs() const;  // of the pass, last frame
  const scene::Frame& lastFrame() const;
  const scene::Geometry& geometry() const;

 private:
  template <class T>
  static std::vector<std::byte> toBytes(const std::vector<T>& values) {
    std::vector<std::byte> raw(values.size() * sizeof(T));
    std::memcpy(raw.data(), values.data(), raw.size());
    return raw;
  }
  PassTest& imageBytes(const std::string& port, VkFormat format, uint32_t width, uint32_t height,
                       uint32_t layers, bool volume, std::vector<std::byte> raw, uint32_t mips = 1);
  PassTest& bufferBytes(const std::string& port, const std::string& element, uint32_t stride, uint64_t count,
                        std::vector<std::byte> raw);
  void setBytes(const std::string& port, std::vector<std::byte> raw);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::test
