// Reservoirs of indirect light (Ouyang et al., "ReSTIR GI: Path Resampling for Real-Time Path Tracing", HPG 2021), and
// how a surface sees the sample of another one.
#ifndef FOVEA_RESERVOIR_GLSL
#define FOVEA_RESERVOIR_GLSL

#include "device/language.glsl"
#include "device/texels.glsl"
#include "records/reservoir.h"

// A reservoir without a sample.
CONSTANT Reservoir kNoReservoir = Reservoir(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

// Reservoir i of a list that is declared as LARGE_TEXELS(vec4, list), and its `count` alone.
#define loadReservoir(list, i) \
  reservoirOf(texelOf(list, 3 * (i)), texelOf(list, 3 * (i) + 1), texelOf(list, 3 * (i) + 2))
#define loadCount(list, i) texelOf(list, 3 * (i)).w
// A reservoir from its texels.
Reservoir reservoirOf(vec4 a, vec4 b, vec4 c) { return Reservoir(vec3(a), a.w, vec3(b), b.w, vec3(c), c.w); }

// What a pixel shows.
struct VisiblePoint {
  vec3 position;  // world space, m
  vec3 normal;    // shading normal, unit
};

// Cosine between the normal of v and the direction to the sample, 0 if it lies behind.
float cosineTowards(VisiblePoint v, Reservoir r) { return max(dot(v.normal, normalize(r.position - v.position)), 0.0); }

// By how much the solid angle of a sample grows from one surface to another (the Jacobian of ReSTIR GI, Eq. 11); 0 if
// one of them lies behind the sample, or if it grows or shrinks by more than the factor `limit`.
float growth(VisiblePoint from, VisiblePoint to, Reservoir r, float limit) {
  vec3 a = from.position - r.position, b = to.position - r.position;
  float facingA = dot(r.normal, a), facingB = dot(r.normal, b), ratio = dot(a, a) / dot(b, b);
  ratio *= sqrt(ratio) * facingB / facingA;
  return facingA > 0.0 && facingB > 0.0 && ratio <= limit && ratio * limit >= 1.0 ? ratio : 0.0;
}

#endif
