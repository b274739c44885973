// Images and texel buffers as GLSL reads them, in memory of the host.
#pragma once

#include <vulkan/vulkan.h>

#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "framework/graph/run/host_kernel.h"

namespace fovea::host {

// Texels in the formats that passes have.
struct Image {
  std::byte* texels = nullptr;
  VkFormat format = VK_FORMAT_UNDEFINED;
  glm::ivec2 size{0};
  size_t rowBytes = 0;

  Image() = default;
  explicit Image(const graph::HostResource& r)
      : texels(r.bytes.data()), format(r.format), size(int(r.width), int(r.height)), rowBytes(r.rowBytes) {}
  template <class T>
  T* at(glm::ivec2 p) const {
    return reinterpret_cast<T*>(texels + size_t(p.y) * rowBytes) + p.x;
  }
};

// The names are those of GLSL.
struct image2D : Image {
  using Image::Image;
};
struct uimage2D : Image {
  using Image::Image;
};
struct texture2D : Image {
  using Image::Image;
};

inline glm::ivec2 imageSize(const Image& image) { return image.size; }
inline glm::ivec2 textureSize(const texture2D& image, int) { return image.size; }

inline glm::vec4 loadTexel(const Image& image, glm::ivec2 p) {
  switch (image.format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return *image.at<glm::vec4>(p);
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return glm::unpackHalf4x16(*image.at<uint64_t>(p));
    case VK_FORMAT_R16G16_SNORM:
      return {glm::unpackSnorm2x16(*image.at<uint32_t>(p)), 0, 1};
    case VK_FORMAT_R32G32_SFLOAT:
      return {*image.at<glm::vec2>(p), 0, 1};
    case VK_FORMAT_R32_SFLOAT:
      return {*image.at<float>(p), 0, 0, 1};
    case VK_FORMAT_R8_UNORM:
      return {float(*image.at<uint8_t>(p)) / 255.0f, 0, 0, 1};
    case VK_FORMAT_R8G8B8A8_UNORM:
      return glm::unpackUnorm4x8(*image.at<uint32_t>(p));
    default:
      return glm::vec4(0);
  }
}

inline glm::vec4 imageLoad(const image2D& image, glm::ivec2 p) { return loadTexel(image, p); }
inline glm::vec4 texelFetch(const texture2D& image, glm::ivec2 p, int) { return loadTexel(image, p); }

inline glm::uvec4 imageLoad(const uimage2D& image, glm::ivec2 p) {
  switch (image.format) {
    case VK_FORMAT_R32G32B32A32_UINT:
      return *image.at<glm::uvec4>(p);
    case VK_FORMAT_R32G32_UINT:
      return {*image.at<glm::uvec2>(p), 0, 1};
    default:
      return {*image.at<uint32_t>(p), 0, 0, 1};
  }
}

inline void imageStore(const image2D& image, glm::ivec2 p, glm::vec4 value) {
  switch (image.format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      *image.at<glm::vec4>(p) = value;
      break;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      *image.at<uint64_t>(p) = glm::packHalf4x16(value);
      break;
    case VK_FORMAT_R32_SFLOAT:
      *image.at<float>(p) = value.x;
      break;
    default:
      break;
  }
}

inline void imageStore(const uimage2D& image, glm::ivec2 p, glm::uvec4 value) {
  *image.at<uint32_t>(p) = value.x;
}

// A texel buffer.
template <class T>
struct Texels {
  const T* list = nullptr;
  int count = 0;

  Texels() = default;
  explicit Texels(const graph::HostResource& r)
      : list(reinterpret_cast<const T*>(r.bytes.data())), count(int(r.bytes.size() / sizeof(T))) {}
  const T& operator[](int i) const { return list[i]; }
};
using samplerBuffer = Texels<glm::vec4>;
inline glm::vec4 texelFetch(const samplerBuffer& texels, int i) { return texels[i]; }

// A storage buffer of many elements, or of one.
template <class T>
struct Elements {
  T* first = nullptr;
  int count = 0;
  T& operator[](size_t i) const { return first[i]; }
  int length() const { return count; }
};
template <class T>
struct List {
  Elements<T> list;
  List() = default;
  explicit List(const graph::HostResource& r)
      : list{reinterpret_cast<T*>(r.bytes.data()), int(r.bytes.size() / sizeof(T))} {}
};
template <class T>
struct Single {
  T& value;
  explicit Single(const graph::HostResource& r) : value(*reinterpret_cast<T*>(r.bytes.data())) {}
};

}  // namespace fovea::host
