// Where the paths end whose turn it is, and the light found there. Defines: RAY_PASSAGE 0/1 (rays/trace.glsl); EMISSION
// 0/1, whether the ends show the light that surfaces emit themselves; LATE 0/1, 1 for those paths whose turn it is not,
// but which are traced as light has changed.
#include "rays/gather.glsl"
#include "records/eye_paths.h"

layout(local_size_x = 64) in;

LIST(readonly, EyePathStart, pathsStarts);
LIST(restrict, EyePathEnd, pathsEnds);
LIST(readonly, uint, turns);  // kPathsAnew and kPathsWait
COUNTERS { uint rays, ends; } counters;
#if LATE
VALUE(readonly, EyePathMemory, memory);
#else
LIST(writeonly, EyePathDifference, differences);
#endif

layout(push_constant) uniform Constants {
  uint points;
  uint bounces;
  uint gathered;
} constants;

CONSTANT EyePathEnd kNoEnd = EyePathEnd(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

float lightOf(EyePathEnd end) { return meanChannel(end.radiance) * end.weight; }

// Path `turn_` of the `paths` that leave a start.
EyePathEnd endOf(EyePathStart start, uint point, uint turn_, uint paths) {
  TracedSurface from = kNothingTraced;
  from.position = start.position;
  from.normal = start.normal;
  from.face = start.face;
  from.origin = start.position + (start.face - normalize(start.position - view.eye)) * rayEpsilon();
  uint stream = randomStream(frame.seed, 0u, kEyePathStream, point);
#if EMISSION
  uint aimed = emitterCount() > 0u ? paths / kAimedShare : 0u;
#else
  const uint aimed = 0u;
#endif
  uint others = paths - aimed;
  bool isAimed = turn_ >= others;
  EmitterRay aim = kNoEmitterRay;
  if (isAimed) aim = aimedRay(from, hashCombine(stream, turn_));
  if (isAimed && !aim.there) return kNoEnd;
  vec3 direction = isAimed ? aim.direction : cosineDirection(start.normal, streamSequence(stream, turn_));
  if (dot(direction, start.face) <= 0.0) return kNoEnd;
  TracedSurface v = arrive(from.origin, direction, kFarAway);
  if (!v.there || (isAimed && v.triangle != aim.triangle)) return kNoEnd;
  Reflection reflection = reflectionOf(v, -direction, reflectance(v), kBounceRoughness);
  vec3 emission = vec3(0.0), radiance = directLight(v, reflection);
#if EMISSION
  emission = emitted(v);
#endif
  float direct = meanChannel(radiance), kind = meanChannel(emission) > direct ? 3.0 : radiance == vec3(0.0) ? 1.0 : 2.0;
  vec3 indirect = passedOn(v, reflection, constants.bounces - 1u, constants.gathered,
                           randomStream(frame.seed, turn_, kPathGatherStream, point));
  if (hasEmitters() && kind < 3.0 && meanChannel(indirect) > direct) kind = 4.0;
  float weight = 1.0;
  if (aimed > 0u) {
    float cosine = cosineDensity(from, direction);
    weight = float(paths) * cosine / (float(others) * cosine + float(aimed) * aimedDensity(from, v));
  }
  return EyePathEnd(v.position, kind, v.face, weight, radiance + emission + indirect, 0.0);
}

void main() {
  uint path = gl_GlobalInvocationID.x, all = uint(pathsEnds.list.length());
  if (path >= all) return;
  uint point = path % constants.points, turn_ = path / constants.points,
       paths = (all - point + constants.points - 1u) / constants.points;
  bool waits = (turns.list[point] & kPathsWait) != 0u, anew = (turns.list[point] & kPathsAnew) != 0u;
#if LATE
  if (!waits || uniformFloat(point * kGoldenRatio) >= memory.value.outOfTurn) return;
#else
  EyePathDifference difference = EyePathDifference(0.0, 0.0, 0.0, 0.0);
  differences.list[path] = difference;
  if (waits) return;
#endif
  EyePathStart start = pathsStarts.list[point];
  EyePathEnd now = kNoEnd;
  if (start.there > 0.0) now = endOf(start, point, turn_, paths);
#if !LATE
  float a = lightOf(pathsEnds.list[path]), b = lightOf(now);
  if (!anew) differences.list[path] = EyePathDifference(abs(b - a), b - a, max(a, b), 0.0);
#endif
  pathsEnds.list[path] = now;
  atomicAdd(counters.rays, rayCount);
}
