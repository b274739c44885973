// Colours for values in debug images.
//
// Needs scene/scene.glsl.
#ifndef FOVEA_COLOUR_MAP_GLSL
#define FOVEA_COLOUR_MAP_GLSL

// The display colour (sRGB) of a value from 0 to 1: dark violet, blue, green, yellow. Brightness rises evenly, so that
// the map can be read without colour vision, too. The knots are every eighth of matplotlib's viridis.
vec3 colourMap(float x) {
  const vec3 knots[9] = vec3[9](vec3(0.267, 0.005, 0.329), vec3(0.283, 0.141, 0.458), vec3(0.230, 0.299, 0.537),
                                vec3(0.173, 0.449, 0.558), vec3(0.127, 0.567, 0.551), vec3(0.158, 0.684, 0.502),
                                vec3(0.369, 0.789, 0.383), vec3(0.678, 0.864, 0.190), vec3(0.993, 0.906, 0.144));
  float t = 8.0 * clamp(x, 0.0, 1.0);
  int i = min(int(t), 7);
  return mix(knots[i], knots[i + 1], t - float(i));
}

// Radiance that tonemap shows as the display colour `srgb` at the scene's exposure.
vec3 displayColour(vec3 srgb) { return pow(srgb, vec3(2.2)) / max(frame.exposure, 1e-9); }

#endif
