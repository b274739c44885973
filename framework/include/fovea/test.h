// The test kit runs one pass alone: it uploads the inputs from arrays, executes the pass through the actual compiler
// and executor with validation layers enabled, and reads back the outputs. Failures are thrown as exceptions, so it
// works with any test framework.
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
  // What belongs to the frame (graph::viewParameters()). Materials are diffuse unless set.
  PassTest& view(const std::string& name, int value);
  PassTest& view(const std::string& name, double value);
  PassTest& view(const std::string& name, const char* value);
  PassTest& viewSize(uint32_t width, uint32_t height);
  PassTest& scene(scene::Scene scene);  // by default empty, with a default camera
  PassTest& seed(uint32_t seed);
  // Where the pass traces rays, if it does; by default on the host if the device is a CPU.
  PassTest& raysOnHost(bool onHost);
  // Called before every frame, for instance to move objects, to cut the camera or to change an input with set().
  PassTest& beforeFrame(std::function<void(PassTest&, scene::Frame&)> hook);

  // `port` is a name such as "radiance", or "surface.position" for a member of a bundle. Texels are tightly packed,
  // layer after layer.
  template <class T>
  PassTest& image(const std::string& port, VkFormat format, uint32_t width, uint32_t height, uint32_t layers,
                  const std::vector<T>& texels) {
    return imageBytes(port, format, width, height, layers, false, toBytes(texels));
  }
  // Texels are tightly packed, slice after slice and mip after mip.
  template <class T>
  PassTest& volume(const std::string& port, VkFormat format, uint32_t width, uint32_t height, uint32_t depth,
                   const std::vector<T>& texels, uint32_t mips = 1) {
    return imageBytes(port, format, width, height, depth, true, toBytes(texels), mips);
  }
  template <class T>
  PassTest& buffer(const std::string& port, const std::vector<T>& values, const std::string& element) {
    return bufferBytes(port, element, sizeof(T), values.size(), toBytes(values));
  }
  // Replaces the contents of an input from the next frame on; the size must stay the same.
  template <class T>
  void set(const std::string& port, const std::vector<T>& values) {
    setBytes(port, toBytes(values));
  }

  // Builds the graph on first use, runs `frames` frames and reads back all outputs of the last one. Throws
  // Error(BadInput) if the inputs do not fit the declaration and std::runtime_error if the validation layers object.
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
  // Texels of an image as floats with interleaved channels, for half, unorm, snorm and float formats. Unorm values
  // map to [0, 1].
  std::vector<float> floats(const std::string& port) const;
  double counter(const std::string& name) const;
  const graph::PassDeclaration& declaration() const;
  double gpuMs() const;  // GPU time of the pass in the last frame, milliseconds
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
