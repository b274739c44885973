// The pixels of a picture around the place where it shows a point.
#ifndef FOVEA_TAPS_GLSL
#define FOVEA_TAPS_GLSL

const float kSameRow = 1e-3;  // pixels

// The four pixels around a place, or two if it lies in a row of centres.
struct Taps {
  ivec2 first;   // the upper left one; it may lie outside the picture
  vec2 between;  // from its centre to the place, pixels, from 0 to 1
  int count;     // 0, 2 or 4
};

// The pixels around the place where the picture of a view shows a point. worldToClip: of the view; point: world space,
// m; size: of the picture, pixels. There are none behind the eye, and none if the place lies outside the picture by
// half a pixel or more.
Taps tapsAround(mat4 worldToClip, vec3 point, ivec2 size) {
  Taps taps = Taps(ivec2(0), vec2(0.0), 0);
  vec4 clip = worldToClip * vec4(point, 1.0);
  if (clip.w <= 0.0) return taps;
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(size) - 0.5;  // pixel centres at whole numbers
  if (any(lessThanEqual(at, vec2(-1.0))) || any(greaterThanEqual(at, vec2(size)))) return taps;
  // Eyes side by side see a point in the same row, up to rounding, in which case two pixels are enough.
  bool sameRow = abs(at.y - round(at.y)) < kSameRow;
  at.y = sameRow ? round(at.y) : at.y;
  return Taps(ivec2(floor(at)), at - floor(at), sameRow ? 2 : 4);
}

// Pixel number i of them, row by row.
ivec2 tapPixel(Taps taps, int i) { return taps.first + ivec2(i & 1, i >> 1); }

// The bilinear weight of pixel number i.
float tapWeight(Taps taps, int i) {
  vec2 w = mix(1.0 - taps.between, taps.between, vec2(i & 1, i >> 1));
  return w.x * w.y;
}

#endif
