// The fovea on the image plane: its disc, the weight of a pixel, and random pixels in it. Image positions are in pixels
// from the top left corner.
#ifndef FOVEA_FOVEA_GLSL
#define FOVEA_FOVEA_GLSL

#include "sampling/random.glsl"
#include "records/fovea.h"

// The fovea of a view. gaze: view.gaze; imageSize: pixels; foveaRadius: parameter `fovea_radius`, in image widths.
Fovea makeFovea(vec2 gaze, vec2 imageSize, float foveaRadius) {
  return Fovea(gaze * imageSize, foveaRadius * imageSize.x);
}

// Foveated weight of an image position: 1 inside r_f, r_f / r outside (passes/README.md, weight-map). It is continuous
// and never 0.
float foveaWeight(Fovea fovea, vec2 position) {
  float r = distance(position, fovea.centre);
  return r <= fovea.radius ? 1.0 : fovea.radius / r;
}

// The region of sample i, kRegionFovea or kRegionImage. region: parameter `region`; imageShare64ths: parameter
// `image_share`, in 64ths; number: how many earlier samples are in the same region.
uint regionOf(uint region, uint imageShare64ths, uint i, OUT(uint) number) {
  number = i;
  if (region != kRegionMixed) return region;
  uint before = i * imageShare64ths >> 6;
  bool image = (i + 1u) * imageShare64ths >> 6 != before;
  number = image ? before : i - before;
  return image ? kRegionImage : kRegionFovea;
}

// Two random numbers, `draw` and the next one of a stream, in [0, 1).
vec2 streamPoint(uint stream, uint draw) {
  return vec2(uniformFloat(hashCombine(stream, draw)), uniformFloat(hashCombine(stream, draw + 1u)));
}

// A random pixel, uniform over the part of the disc that lies in the image (a pixel on its edge in proportion to the
// part inside) or over the whole image. Works by rejection from the bounding box of that part, at least half of which
// is inside, as the part is convex and touches the sides of the box. If all tries fail (one in 2^32 at worst) or the
// fovea lies outside the image, the pixel is uniform over the image. region: kRegionFovea or kRegionImage; stream: of
// random numbers, of which the first kRegionDraws are taken.
ivec2 regionSample(uint region, Fovea fovea, ivec2 imageSize, uint stream) {
  vec2 low = vec2(0.0), high = vec2(imageSize);
  vec2 off = max(max(-fovea.centre, fovea.centre - high), vec2(0.0));  // offset from the centre to the image
  vec2 flipped = vec2(off.y, off.x);
  // extent of the disc at the image border
  vec2 reach = sqrt(max(fovea.radius * fovea.radius - flipped * flipped, 0.0));
  bool disc = region == kRegionFovea && dot(off, off) < fovea.radius * fovea.radius;
  if (disc) {
    vec2 boxLow = max(low, fovea.centre - reach), boxHigh = min(high, fovea.centre + reach);
    for (uint i = 0u; i < kRegionTries; ++i) {
      vec2 position = mix(boxLow, boxHigh, streamPoint(stream, 2u * i));
      vec2 d = position - fovea.centre;
      if (dot(d, d) <= fovea.radius * fovea.radius) return clamp(ivec2(position), ivec2(0), imageSize - 1);
    }
  }
  vec2 position = high * streamPoint(stream, 2u * kRegionTries);
  return clamp(ivec2(position), ivec2(0), imageSize - 1);
}

// Keeps the random numbers of screenPoint() apart from others.
CONSTANT uint kPointsStream = 0x77656967u;

// Point i of the R2 sequence, in [0, 1).
vec2 sequencePoint(uint i) { return r2Sequence(uvec2(0x80000000u), i); }

// The pixel of point i of `points` that stay the same from frame to frame: the R2 sequence over the box of the region,
// by rejection as in regionSample(). Point i takes the points i, i + points, i + 2 points and so on of the sequence
// until one lies inside. region, imageShare64ths: as in regionOf(); size: of the image, pixels.
ivec2 screenPoint(uint region, uint imageShare64ths, uint i, uint points, Fovea fovea, ivec2 size) {
  uint number, part = regionOf(region, imageShare64ths, i, number);
  vec2 high = vec2(size);
  if (part == kRegionImage) return clamp(ivec2(high * sequencePoint(number)), ivec2(0), size - 1);
  vec2 off = max(max(-fovea.centre, fovea.centre - high), vec2(0.0)), flipped = vec2(off.y, off.x);
  vec2 reach = sqrt(max(fovea.radius * fovea.radius - flipped * flipped, 0.0));
  vec2 boxLow = max(vec2(0.0), fovea.centre - reach), boxHigh = min(high, fovea.centre + reach);
  if (dot(off, off) < fovea.radius * fovea.radius)
    for (uint k = 0u; k < kRegionTries; ++k) {
      vec2 position = mix(boxLow, boxHigh, sequencePoint(number + k * points)), d = position - fovea.centre;
      if (dot(d, d) <= fovea.radius * fovea.radius) return clamp(ivec2(position), ivec2(0), size - 1);
    }
  return regionSample(part, fovea, size, randomStream(0u, 0u, kPointsStream, number));
}

#endif
