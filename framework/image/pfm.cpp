#include "framework/image/pfm.h"

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace fovea::image {

static_assert(std::endian::native == std::endian::little);

void writePfm(const std::filesystem::path& file, const codec::Pixels& pixels) {
  std::ofstream stream(file, std::ios::binary);
  stream << (pixels.channels.size() == 1 ? "Pf" : "PF") << '\n'
         << pixels.width << ' ' << pixels.height << "\n-1.0\n";
  const size_t row = pixels.width * pixels.channels.size();
  for (size_t y = pixels.height; y-- > 0;)
    stream.write(reinterpret_cast<const char*>(&pixels.data[y * row]), std::streamsize(row * sizeof(float)));
  stream.close();
  if (!stream) throw std::runtime_error(errno ? std::strerror(errno) : "the write failed");
}

codec::Pixels readPfm(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string kind;
  uint32_t width = 0, height = 0;
  double scale = 0;  // negative if little-endian
  stream >> kind >> width >> height >> scale;
  stream.get();
  if (!stream || (kind != "PF" && kind != "Pf")) throw std::runtime_error("it has no PFM header");
  if (width < 1 || height < 1 || width > codec::kMaxSide || height > codec::kMaxSide || scale == 0)
    throw std::runtime_error("its PFM header is out of range");
  codec::Pixels pixels{width, height, {}, {}, {}};
  pixels.channels = kind == "Pf" ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  const size_t row = width * pixels.channels.size();
  const auto begin = stream.tellg();
  stream.seekg(0, std::ios::end);
  if (size_t(stream.tellg() - begin) < row * height * sizeof(float))
    throw std::runtime_error("it ends too early");
  stream.seekg(begin);
  pixels.data.resize(row * height);
  for (size_t y = height; y-- > 0;)
    stream.read(reinterpret_cast<char*>(&pixels.data[y * row]), std::streamsize(row * sizeof(float)));
  if (!stream) throw std::runtime_error("it ends too early");
  if (scale > 0) {
    for (float& v : pixels.data) {
      const uint32_t b = std::bit_cast<uint32_t>(v);
      v = std::bit_cast<float>((b >> 24) | ((b >> 8) & 0xff00u) | ((b << 8) & 0xff0000u) | (b << 24));
    }
  }
  return pixels;
}

}  // namespace fovea::image
