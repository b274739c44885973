// Moves the exposure towards that with which the mean brightness of the picture is the key (Reinhard et al.,
// "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, Eq. 1 and 2), by a share of the difference in
// stops, as an eye that adapts does. The first exposure after a camera cut is reached at once.

layout(local_size_x = 1) in;

layout(r32f) uniform readonly image2D tiles;
layout(r32f) uniform image2D exposure;

layout(push_constant) uniform Constants {
  float sceneExposure;
  uint adapts;   // 0: the scene's exposure stays
  float key;
  float range;   // stops
  float frames;
};

void main() {
  ivec2 size = imageSize(tiles);
  float sum = 0.0;
  for (int i = 0; i < size.x * size.y; ++i) sum += imageLoad(tiles, ivec2(i % size.x, i / size.x)).r;
  float stops = clamp(log2(key) - sum / float(size.x * size.y), -range, range);
  float before = imageLoad(exposure, ivec2(0)).r;  // 0 in the first frame
  if (before > 0.0) stops = mix(log2(before / sceneExposure), stops, 1.0 - exp(-1.0 / frames));
  imageStore(exposure, ivec2(0), vec4(adapts != 0u ? sceneExposure * exp2(stops) : sceneExposure));
}
