// Where the paths of each screen point start, and whether it is their turn. Define: RAY_PASSAGE 0/1 (rays/trace.glsl).
#include "sampling/fovea.glsl"
#include "rays/surfaces.glsl"
#include "records/eye_paths.h"

layout(local_size_x = 64) in;

LIST(restrict, EyePathStart, pathsStarts);
LIST(writeonly, uint, turns);  // kPathsAnew and kPathsWait
COUNTERS { uint rays, ends; } counters;

layout(push_constant) uniform Constants {
  uint region;
  uint imageShare64ths;
  float foveaRadius;
  uint points;
  uint renew;  // frames
  uint traceFrames;
  float strayNow;  // image widths
  uint frameIndex;
} constants;

CONSTANT float kRounding = 1e-6;  // of a unit vector

EyePathStart startAt(vec2 pixel) {
  TracedSurface v = look(pixel);
  if (!v.there) return EyePathStart(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
  return EyePathStart(v.position, 1.0, v.normal, 0.0, v.face, 0.0);
}

// Whether the eye still sees the start, and close to `pixel`, where it belongs.
bool belongs(EyePathStart start, vec2 pixel) {
  if (constants.strayNow == 0.0 || start.there == 0.0) return false;
  vec4 clip = view.worldToClip * vec4(start.position, 1.0);
  if (!(clip.w > 0.0)) return false;
  vec2 at = (vec2(clip) / clip.w * 0.5 + 0.5) * view.size;
  bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, view.size));
  if (!inside || distance(at, pixel) > constants.strayNow * view.size.x) return false;
  TracedSurface v = look(at);
  float reach = max(4.0 * rayEpsilon(), kSamePlace * distance(start.position, view.eye));
  return v.there && distance(v.position, start.position) <= reach;
}

// Whether the surface (or the background) is still where the start was found, as objects may have moved. The start
// follows one that moves or turns slowly: paths from below it would meet its inside.
bool stands(INOUT(EyePathStart) start) {
  if (start.there == 0.0) return true;
  float reach = 4.0 * rayEpsilon();
  Ray ray = Ray(start.position + reach * start.face, -start.face, 0.0, 2.0 * reach);
  ++rayCount;
  RayHit hit = intersect(ray);
  if (hit.triangle == kNoTriangle) return false;
  TracedSurface found = surfaceOf(hit, ray.direction);
  float risen = reach - hit.distance;
  if (distance(found.face, start.face) <= kRounding && abs(risen) <= kStill * rayEpsilon()) return true;
  float cosine = dot(found.face, start.face);
  start = EyePathStart(start.position + risen * start.face, 1.0, found.normal, 0.0, found.face, 0.0);
  return cosine > kSameFace;
}

void main() {
  uint point = gl_GlobalInvocationID.x;
  if (point >= constants.points) return;
  Fovea fovea = makeFovea(view.gaze, view.size, constants.foveaRadius);
  vec2 pixel = vec2(screenPoint(constants.region, constants.imageShare64ths, point, constants.points, fovea,
                                ivec2(view.size))) +
               0.5;
  EyePathStart start = pathsStarts.list[point];
  bool anew = point % constants.renew == constants.frameIndex % constants.renew && !belongs(start, pixel);
  if (!anew) anew = !stands(start);
  if (anew) start = startAt(pixel);
  pathsStarts.list[point] = start;
  bool waits = !anew && point % constants.traceFrames != constants.frameIndex % constants.traceFrames;
  turns.list[point] = (anew ? kPathsAnew : 0u) | (waits ? kPathsWait : 0u);
  atomicAdd(counters.rays, rayCount);
}
