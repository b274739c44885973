// The first voxel side along the ray of each pixel.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"
#include "screen/colour_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba16f) uniform writeonly image2D image;
#if RADIANCE
LARGE_TEXELS(vec4, radiance);
#endif
#if WEIGHT
LARGE_TEXELS(float, weights);
#endif

vec3 colourOf(uint side) {
#if RADIANCE
  return texelOf(radiance, int(side)).rgb;
#elif WEIGHT
  return displayColour(colourMap(texelOf(weights, int(side)).r));
#elif NORMAL
  return displayColour(0.5 + 0.5 * loadSide(side).normal);
#else
  return displayColour(pow(loadSide(side).reflectance, vec3(1.0 / 2.2)));
#endif
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image);
  if (any(greaterThanEqual(p, size))) return;
  vec2 ndc = 2.0 * (vec2(p) + 0.5) / vec2(size) - 1.0;
  vec3 inView = vec3((ndc + view.viewToClip[2].xy) / vec2(view.viewToClip[0][0], view.viewToClip[1][1]), -1.0);
  vec3 direction = normalize(transpose(mat3(view.worldToView)) * inView);
  VoxelHit hit = traceVoxels(voxelsGrid(), view.eye, direction, direction);
#if RADIANCE
  vec3 colour = frame.environment;
#else
  vec3 colour = vec3(0.0);
#endif
  if (hit.side != kNoSide) colour = colourOf(hit.side);
  imageStore(image, p, vec4(min(colour, vec3(65504.0)), 1.0));
}
