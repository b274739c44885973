// An environment map: light from all directions, from infinitely far away.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "fovea/error.h"

namespace fovea::scene {

// An equirectangular map: the middle of the picture is seen along -Z and its upper edge is the zenith, +Y. Light is
// interpolated between the centres of the texels.
class EnvironmentMap {
 public:
  // texels: radiance, W/(sr m^2), in rows from the zenith down; what is not finite or below 0 counts as black. turn: the
  // angle in radians by which the map is turned about +Y, counter-clockwise seen from above.
  EnvironmentMap(uint32_t width, uint32_t height, std::vector<glm::vec3> texels, float turn = 0);

  // direction: unit.
  glm::vec3 radiance(glm::vec3 direction) const;

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  const std::vector<glm::vec3>& texels() const { return texels_; }
  float turn() const { return turn_; }
  // With these, shaders choose directions in proportion to the light that comes from there (shaders/rays/emitters.glsl).
  // columns() has the cumulative shares of the light within each row, one row of the map after the other, and rows()
  // those of the rows. All are 0 where the map is black.
  const std::vector<float>& columns() const { return columns_; }
  const std::vector<float>& rows() const { return rows_; }

 private:
  struct Place {  // in texels, from the upper left corner
    float x, y;
  };
  Place placeOf(glm::vec3 direction) const;
  const glm::vec3& texel(int x, int y) const;
  float solidAngle(uint32_t row) const;  // of a texel, sr

  uint32_t width_, height_;
  std::vector<glm::vec3> texels_;
  float turn_;
  // Each row of columns_ ends with 1, and so does rows_.
  std::vector<float> columns_, rows_;
};

// Reads an EXR, HDR or PFM image, whose values are multiplied by `intensity`. Throws Error(BadInput) that names the file
// if it cannot be read or is not twice as wide as high.
std::shared_ptr<const EnvironmentMap> loadEnvironment(const std::filesystem::path& file, float intensity,
                                                      float turn);

}  // namespace fovea::scene
