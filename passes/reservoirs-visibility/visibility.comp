// Which pixels see the samples that they are about to share. Defines: RAY_PASSAGE 0/1 (rays/trace.glsl); MOVED 0/1, 1
// if the sources belong to the previous frame.
#include "rays/visibility.glsl"
#include "sampling/reservoir.glsl"
#include "screen/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

SURFACES(gbuffer, surfaceAt)
IMAGE(rg16_snorm, readonly, image2D, gbufferFace);
#if MOVED
IMAGE(rgba32f, readonly, image2D, movedPosition);
IMAGE(rg16_snorm, readonly, image2D, movedFace);
#endif
LARGE_TEXELS(vec4, own);
LARGE_TEXELS(vec4, others);
IMAGE(r32ui, readonly, uimage2D, sources);
IMAGE(r32ui, writeonly, uimage2D, seen);
COUNTERS { uint rays, hidden; } counters;

CONSTANT uint kNone = 0xffffffffu;  // in place of a pixel: none

uint rayCount = 0u, reachedCount = 0u;

vec3 faceAt(ivec2 pixel) { return octDecode(vec2(imageLoad(gbufferFace, pixel))); }
#if MOVED
vec3 sourceAt(ivec2 pixel) { return vec3(imageLoad(movedPosition, pixel)); }
vec3 sourceFaceAt(ivec2 pixel) { return octDecode(vec2(imageLoad(movedFace, pixel))); }
#else
vec3 sourceAt(ivec2 pixel) { return vec3(surfaceAt(pixel)); }
vec3 sourceFaceAt(ivec2 pixel) { return faceAt(pixel); }
#endif

// Whether a point of a surface sees the sample. face: unit, on the side of the eye.
bool sees(vec3 position, vec3 face, Reservoir r) {
  bool facing = dot(r.position - position, face) > 0.0 && dot(position - r.position, r.normal) > 0.0;
  if (!(r.weight > 0.0) || !facing || frame.triangleCount == 0u) return false;
  vec3 origin = position + (face - normalize(position - view.eye)) * rayEpsilon();
  vec3 to = r.position + r.normal * rayEpsilon() - origin;
  ++rayCount;
  bool reached = visibility(Ray(origin, to, 0.0, kReservoirRayEnd)) != vec3(0.0);
  reachedCount += uint(reached);
  return reached;
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID), size = imageSize(gbufferDistance);
  if (any(greaterThanEqual(p, size))) return;
  vec3 position = vec3(surfaceAt(p)), face = faceAt(p);
  Reservoir mine = loadReservoir(own, p.y * size.x + p.x);
  int each = imageSize(sources).x / size.x;
  uint bits = 0u;
  for (int k = 0; k < each; ++k) {
    uint source = imageLoad(sources, ivec2(p.x * each + k, p.y)).r;
    if (source == kNone) continue;
    ivec2 q = ivec2(source & 0xffffu, source >> 16);
    bool mineSees = sees(position, face, loadReservoir(others, q.y * size.x + q.x)),
         itsSees = sees(sourceAt(q), sourceFaceAt(q), mine);
    bits |= uint(mineSees) << 2 * k | uint(itsSees) << (2 * k + 1);
  }
  imageStore(seen, p, uvec4(bits, 0u, 0u, 0u));
  atomicAdd(counters.rays, rayCount);
  atomicAdd(counters.hidden, rayCount - reachedCount);
}
