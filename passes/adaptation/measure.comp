// The mean brightness of each tile of the picture, from pixels that lie evenly in it.

layout(local_size_x = 8, local_size_y = 8) in;

uniform texture2D radiance;
layout(r32f) uniform writeonly image2D tiles;

layout(push_constant) uniform Constants { float sceneExposure; };

const int kPixels = 8;          // along each axis of a tile
const float kLeast = 1.0 / 1024.0;  // display intensity: what is darker is as dark as this to the eye

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy), size = textureSize(radiance, 0);
  vec2 step = vec2(size) / vec2(imageSize(tiles) * kPixels);
  float sum = 0.0;
  for (int i = 0; i < kPixels * kPixels; ++i) {
    ivec2 p = ivec2((vec2(tile * kPixels + ivec2(i % kPixels, i / kPixels)) + 0.5) * step);
    float luminance = dot(texelFetch(radiance, min(p, size - 1), 0).rgb, vec3(0.2126, 0.7152, 0.0722));
    float shown = luminance * sceneExposure;
    sum += log2(shown > kLeast && shown < 1e6 ? shown : kLeast);  // NaN and infinity count as dark
  }
  imageStore(tiles, tile, vec4(sum / float(kPixels * kPixels)));
}
