#include "passes/path-trace/surface_table.h"

#include <cmath>
#include <cstring>

namespace fovea::path_trace {

SurfaceTable::SurfaceTable(const scene::Frame& frame) {
  copyTriangles(*frame.geometry);
  copyTexels(*frame.scene);
}

void SurfaceTable::copyTriangles(const scene::Geometry& geometry) {
  triangles_.resize(geometry.triangles.size());
  for (uint32_t i = 0; i < triangles_.size(); ++i) {
    const scene::TriangleVertices from = scene::triangleVertices(geometry, i);
    const scene::SurfaceHit middle = scene::surfaceAt(from, 1 / 3.0f, 1 / 3.0f);
    Triangle& t = triangles_[i];
    t.face = middle.geometricNormal;
    t.material = middle.material;
    for (int k = 0; k < 3; ++k) {
      t.uvs[k] = from.uvs[k];
      for (int c = 0; c < 3; ++c)
        t.normals[k][c] = int16_t(std::lround(32767 * glm::clamp(from.normals[k][c], -1.0f, 1.0f)));
    }
  }
}

void SurfaceTable::copyTexels(const scene::Scene& scene) {
  std::vector<Blocks> blocks(scene.textures.size());
  size_t size = 0;
  for (const scene::Material& m : scene.materials) {
    Look& look = looks_.emplace_back();
    look.factor = glm::vec3(m.baseColor) * (1.0f - m.meanMetallic());
    look.doubleSided = m.doubleSided;
    look.emits = m.emission != glm::vec3(0);
    look.use = m.baseColorTexture;
    if (look.use.texture >= blocks.size()) continue;
    const scene::Texture& t = scene.textures[look.use.texture];
    Blocks& b = blocks[look.use.texture];
    if (b.width == 0 && t.width != 0 && t.height != 0) {
      b = {t.width, t.height, (t.width + 31) / 32, t.srgb, size};
      size += size_t(4096) * b.perRow * ((t.height + 31) / 32);
    }
    look.blocks = b;
  }
  texels_.resize(size);
  for (size_t i = 0; i < blocks.size(); ++i) {
    const Blocks& b = blocks[i];
    const uint8_t* from = scene.textures[i].rgba.data();
    for (uint32_t y = 0; y < b.height; ++y)
      for (uint32_t x = 0; x < b.width; ++x, from += 4)
        std::memcpy(&texels_[b.first + Blocks::column(x) + b.row(y)], from, 4);
  }
}

}  // namespace fovea::path_trace
