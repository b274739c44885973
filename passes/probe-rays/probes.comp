// Which share of its rays each probe traces: one of so many.
#include "sampling/fovea.glsl"
#include "screen/pixel_ray.glsl"
#include "probes/layout.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer RaysGridBlock { ProbeGrid value; } raysGrid;
uniform samplerBuffer probesStates;
layout(std430) writeonly buffer SharesBlock { uint list[]; } shares;
layout(std430) buffer CountersBlock { uint rays, probes, inside; } counters;

layout(push_constant) uniform Constants {
  uint outsideShare;
  float foveaRadius;
  float bias;
};

const int kRim = 64;  // directions around the fovea

// Whether a probe lights points that the eye may see in the fovea: those less than a cell away from its own cell's
// centre, and the bias off their surface.
bool isInFovea(vec3 centre, float spacing) {
  float reach = (sqrt(3.0) + bias) * spacing;
  vec3 to = centre - view.eye;
  float distance_ = length(to);
  if (distance_ <= reach) return true;
  Fovea fovea = makeFovea(view.gaze, view.size, foveaRadius);
  vec4 clip = view.worldToClip * vec4(centre, 1.0);
  if (clip.w > 0.0 && distance(view.size * (0.5 * clip.xy / clip.w + 0.5), fovea.centre) <= fovea.radius) return true;
  // The sphere around the probe meets the cone of the fovea where the angle to its rim is below that of the sphere.
  float least = sqrt(distance_ * distance_ - reach * reach);
  for (int i = 0; i < kRim; ++i) {
    float a = 2.0 * kPi * float(i) / float(kRim);
    if (dot(normalize(pixelRay(fovea.centre + fovea.radius * vec2(cos(a), sin(a)))), to) >= least) return true;
  }
  return false;
}

void main() {
  int probe = int(gl_GlobalInvocationID.x);
  ProbeGrid grid = raysGrid.value;
  if (probe >= shares.list.length()) return;
  shares.list[probe] = 0u;
  if (probe >= probesOf(grid) || frame.triangleCount == 0u) return;  // of an empty scene nothing is known
  bool inside = loadProbe(probesStates, probe).inside > 0.0;
  vec3 centre = grid.origin + grid.spacing * vec3(probeCell(grid, probe));
  bool outside = outsideShare > 1u && !isInFovea(centre, grid.spacing);
  shares.list[probe] = max(inside ? kInsideShare : 1u, outside ? outsideShare : 1u);
  if (inside) atomicAdd(counters.inside, 1u);
}
