// The first camera's picture as a path tracer with few samples sees it, if the surfaces in it reflect indirect light as
// diffuse ones of their colour, metals too. It runs on the host when a scene is loaded (framework/host/light_meter.cpp).
// Define: RAY_PASSAGE as 1.
#include "rays/gather.glsl"
#include "records/light_meter.h"

layout(local_size_x = 8, local_size_y = 8) in;

LIST(writeonly, MeterPoint, points);  // row after row

CONSTANT uint kBounces = 2u, kGathered = 4u;  // kGathered: rays for further bounces at each pixel

void main() {
  uvec2 pixel = uvec2(gl_GlobalInvocationID), size = uvec2(view.size);
  if (any(greaterThanEqual(pixel, size))) return;
  vec2 at = vec2(pixel) + 0.5;
  vec3 direction = normalize(pixelRay(at));
  TracedSurface v = look(at);
  MeterPoint point = MeterPoint(v.position, float(v.there), v.origin, 0.0, v.normal, 0.0, vec3(0.0), 0.0);
  if (v.there) {
    uint stream = randomStream(1u, pixel.x, 0u, pixel.y);
    Reflection r = reflectionOf(v, -direction, vec3(0.0), 0.0);
    vec3 emission = v.brighter * r.emission, gathered = gather(v, kBounces, kGathered, stream);
    vec3 arriving = gathered + irradianceAt(v) / kPi;
    point.radiance = emission + directLight(v, r) + reflectance(v) * gathered;
    point.emitted = max(max(emission.x, emission.y), emission.z);
    point.arriving = max(max(arriving.x, arriving.y), arriving.z);
  } else {
    point.radiance = hasEnvironmentMap() ? environmentRadiance(direction) : frame.environment;
  }
  points.list[pixel.y * size.x + pixel.x] = point;
}
