// The mean of what was found at a pixel and at the eight around it, as far as they are in contact and show the same
// surface. A few rays are a poor estimate, and a narrow window hardly widens the shadow of what is close. Define:
// FILTER 0/1, 0 takes the pixel alone.
#include "screen/same_surface.glsl"
#include "contact_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f) uniform readonly image2D unfiltered;
layout(rgba16f) uniform writeonly image2D light;

layout(push_constant) uniform Constants {
  ivec4 fovea;  // square around it: its first pixel, and the one behind its last
  float longer;
};

// Of a pixel in a row of three, by its distance from the middle.
float rowWeight(int steps) { return steps == 0 ? kMiddleWeight : 1.0; }

void main() {
  ivec2 p = fovea.xy + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, fovea.zw)) || !inContact(p)) return;
#if FILTER
  ContactSurface at = contactSurface(p);
  ivec2 low = max(p - 1, fovea.xy), high = min(p + 1, fovea.zw - 1);
  vec4 sum = vec4(0.0);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      ivec2 q = ivec2(x, y), steps = abs(q - p);
      if (!inContact(q)) continue;
      ContactSurface other = contactSurface(q);
      if (q != p && !onSamePlane(at.position, at.normal, other.position, other.normal)) continue;
      sum += rowWeight(steps.x) * rowWeight(steps.y) * vec4(imageLoad(unfiltered, q).rgb, 1.0);
    }
  vec3 mean = sum.rgb / sum.a;
#else
  vec3 mean = imageLoad(unfiltered, p).rgb;
#endif
  imageStore(light, p, vec4(mean, longer));
}
