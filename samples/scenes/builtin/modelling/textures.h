// Procedural pictures of the built-in scenes, baked to 8 bits. They are deterministic, and seamless where stated.
// Colours are linear reflectances, and the pictures are stored sRGB-encoded. Textures are sampled without mipmaps, so
// fine detail should stay faint, and a picture of 512 pixels should span about 2 to 5 m.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene::model {

// Evaluates the colour at the middle of each pixel, with u to the right and v down in 0..1; the vec4 includes alpha.
Texture bake(const std::string& name, uint32_t width, uint32_t height,
             const std::function<glm::vec3(float u, float v)>& color);
Texture bakeWithAlpha(const std::string& name, uint32_t width, uint32_t height,
                      const std::function<glm::vec4(float u, float v)>& color);

// All textures below repeat without a seam, except leaf(). `seed` changes the pattern; `size` is the width in pixels.
struct MasonryLook {
  int columns = 4, rows = 8;         // number of blocks in the picture
  float joint = 0.08f;               // as a share of a row's height
  glm::vec3 low{0.35f}, high{0.5f};  // colours of blocks lie between these two
  glm::vec3 jointColor{0.25f};
  float weathering = 0.15f;  // 0..1: stains and grain within a block
  bool staggered = true;     // shifts every other row by half a block, and each row slightly
};
Texture masonry(const std::string& name, const MasonryLook& look, uint32_t width, uint32_t height,
                uint32_t seed);
// Plaster, concrete or stucco: large clouds and fine grain; `stains` adds darker streaks that run down.
Texture plaster(const std::string& name, glm::vec3 color, float contrast, float stains, uint32_t size,
                uint32_t seed);
// Boards side by side (u across them, v along the grain).
Texture boards(const std::string& name, int count, glm::vec3 low, glm::vec3 high, uint32_t size,
               uint32_t seed, float gap = 0.012f);
// Woven cloth of `threads` threads in the picture, with a faint weave.
Texture weave(const std::string& name, glm::vec3 color, int threads, uint32_t size, uint32_t seed);
// Stripes along v. Widths are scaled to fill the picture.
struct Stripe {
  glm::vec3 color;
  float width;
};
Texture stripes(const std::string& name, const std::vector<Stripe>& pattern, uint32_t size, uint32_t seed);
// Earth, gravel or grass: patches of two colours with speckles.
Texture ground(const std::string& name, glm::vec3 low, glm::vec3 high, float speckle, uint32_t size,
               uint32_t seed);
// One leaf, point up, on a transparent ground, for cards with a mask. Does not repeat. Prefer modelled leaves
// near the camera.
Texture leaf(const std::string& name, glm::vec3 color, uint32_t size, uint32_t seed);
// Many small leaves with gaps between them; `cover` is the opaque share.
Texture foliage(const std::string& name, glm::vec3 low, glm::vec3 high, float cover, uint32_t size,
                uint32_t seed);

}  // namespace fovea::scene::model
