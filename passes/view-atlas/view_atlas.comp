// The maps of the shadow atlas side by side, in the order of their slots.
#include "scene/scene.glsl"
#include "vpls/paraboloid.glsl"
#include "screen/colour_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui) uniform readonly uimage2DArray atlas;
layout(rgba16f) uniform writeonly image2D image;

layout(push_constant) uniform Constants {
  int columns;
  int tile;     // px
  float range;  // m
};

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(image)))) return;
  ivec3 sizes = imageSize(atlas);
  AtlasLayout layout_ = atlasLayout(sizes);
  int slot = p.y / tile * columns + p.x / tile;
  vec2 inMap = (vec2(p % tile) + 0.5) / float(tile);
  vec3 colour = vec3(0.0);
  if (slot < sizes.z << layout_.shift) {
    ivec2 texel = ivec2(inMap * float(layout_.size));
    uint bits = imageLoad(atlas, atlasTexel(uint(slot), texel, layout_)).r;
    vec2 q = paraboloidTexelCentre(texel, layout_.size);
    if (dot(q, q) < 1.0)
      colour = bits == kParaboloidEmpty ? vec3(0.05, 0.05, 0.3) : vec3(exp2(-uintBitsToFloat(bits) / range));
  }
  imageStore(image, p, vec4(displayColour(colour), 1.0));
}
