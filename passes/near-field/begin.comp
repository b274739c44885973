// What the rays of this frame need to know. Defines: CHANGE and GIVEN_AREA 0/1, whether the inputs `change` and
// `least_area` are wired.
#include "records/near_field.h"
#include "scene/scene.glsl"

layout(local_size_x = 1) in;

#if CHANGE
layout(std430) readonly buffer ChangeBlock { vec4 list[]; } change;
#endif
#if GIVEN_AREA
layout(std430) readonly buffer LeastAreaBlock { vec4 list[]; } leastArea;
#endif
layout(std430) buffer StateBlock { NearFieldState value; } state;
layout(std430) writeonly buffer SumsBlock { NearFieldSums value; } sums;
layout(std430) writeonly buffer SpreadBlock { vec4 list[]; } spread;

layout(push_constant) uniform Constants {
  float share;
  uint vpls;
  uint foveaSamples;
  uint saccadeSamples;
  float saccade;
  uint onlyLength;  // 1: no light is found
  uint isFirst;
};

void main() {
#if CHANGE
  vec4 changed = change.list[0];
#else
  vec4 changed = vec4(0.0);
#endif
  // The diagonal stands for the mean length as long as no surface sees another: light of the environment is found
  // all the same.
  float known = state.value.meanLength > 0.0 ? state.value.meanLength : diagonal();
#if GIVEN_AREA
  float area = leastArea.list[0].x;
#else
  float area = share * known * known / float(vpls);
#endif
  state.value.area = onlyLength != 0u ? 0.0 : area;
  state.value.cellWidth = kNearCellWidth * known;
  state.value.ageing = changed.y;
  float lost = saccade > 0.0 ? 1.0 : changed.z;
  uint most = max(saccadeSamples, foveaSamples);
  state.value.foveaRays =
      isFirst != 0u ? 1u : uint(floor(mix(float(foveaSamples), float(most), lost) + 0.5));
  sums.value = NearFieldSums(0u, 0u, 0u, 0u);
  spread.list[0] = vec4(state.value.area, 0.0, 0.0, 0.0);
}
