// A part of the sample of each block in the list, or all of it: that of one turn. Defines: RAY_PASSAGE and MAP_ALONE
// (rays/near_light.glsl); GLOSS 0/1, 1 to find also the light under lobes; LOBES 0/1, 1 if the G-buffer says what
// these are.
#include "screen/blocks.glsl"
#include "device/sums.glsl"
#include "rays/gather_cache.glsl"
#include "rays/near_light.glsl"
#include "screen/same_surface.glsl"
#if LOBES
#include "receiver_lobe.glsl"
#endif

layout(local_size_x = 64) in;  // kItemsInGroup

VALUE(readonly, NearFieldState, state);
VALUE(restrict, NearFieldSums, sums);
LIST(restrict, NearFieldTile, tiles);
LIST(readonly, uint, items);
VALUE(readonly, uint, listed);
LIST(restrict, vec4, traced);  // rgb: irradiance / pi; a: code of the sample, see main()
#if GLOSS
LIST(restrict, vec4, tracedGloss);  // rgb: under the lobe
#endif
COUNTERS { uint rays, shaded, gathered; } counters;

layout(push_constant) uniform Constants {
  uint spacing;
  uint bounces;
  uint emitterPoints;
  float reach;
  uint frameIndex;
  uint part;   // number of this turn
  uint parts;  // number of turns
} constants;

float discArea() { return state.value.area; }
float reach() { return constants.reach; }
float raysOfSample = 1.0;
void noteLength(float distance_, float probability) {  // all samples count alike, however many rays they have
  float weight = 1.0 / (probability * raysOfSample);
  ADD_TO_SUM(sums.value.hits, sums.value.hitsHigh, weight);
  ADD_TO_SUM(sums.value.diagonals, sums.value.diagonalsHigh, weight * distance_ / diagonal());
}
vec3 furtherLight(TracedSurface v, uint bounces, uint stream) {
  return gatheredLight(v, bounces, stream, state.value.cellWidth, state.value.ageing);
}

#if LOBES
ReceiverLobe lobe;  // of the surface whose light is found
float underLobe(vec3 direction, float cosine) { return response(lobe, direction, cosine); }
#else
float underLobe(vec3 direction, float cosine) { return 1.0; }
#endif

// A block of pixels that has a sample.
struct Block {
  uint side;     // pixels
  uvec2 number;  // in x and y
  ivec2 corner;  // its first pixel, which may lie outside the view
  uint place;    // of its sample in `traced`
};

Block blockOf(uint item) {
  uint index = item & ~kWideItem;
  if (index == item) {
    uvec2 texel = uvec2(index % texelCount().x, index / texelCount().x);
    return Block(2u, texel, ivec2(2u * texel), index);
  }
  uvec2 tile = tileOf(index, constants.spacing);
  ivec2 corner = tileCorner(tile, constants.spacing, constants.frameIndex);
  return Block(constants.spacing, tile, corner, firstTexel(corner));
}

ivec2 pixelOf(uint turn_, Block block) {
  ivec2 pixel = block.corner + ivec2(samplePixel(turn_, block.side, block.number));
  return clamp(pixel, ivec2(0), ivec2(viewSize()) - 1);
}

TracedSurface seenIn(uint turn_, Block block) { return look(vec2(pixelOf(turn_, block)) + 0.5); }

void main() {
  uint number = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (number >= listed.value) return;
  uint item = items.list[number];
  Block block = blockOf(item);
  bool wide = (item & kWideItem) != 0u;
  uint rays = block.side == 2u ? state.value.foveaRays : 1u;
  raysOfSample = float(rays);
  // Rays leave from the surface of the first turn's pixel, too, where another pixel shows another surface.
  TracedSurface at = seenIn(constants.frameIndex, block), v = at;
  if (constants.part > 0u) v = seenIn(constants.frameIndex + constants.part, block);
  bool leavesFirst = !v.there || !onSamePlane(at.position, at.normal, v.position, v.normal);
  if (leavesFirst) v = at;
#if LOBES
  uint turn_ = leavesFirst ? constants.frameIndex : constants.frameIndex + constants.part;
  if (v.there) lobe = receiverLobe(pixelOf(turn_, block), v.position);
#endif
  NearLight sum = NearLight(vec3(0.0), vec3(0.0));
  for (uint i = 0u; at.there && i < rays; ++i) {
    NearLight its = nearLight(v, block.number, rays * (constants.frameIndex + constants.part) + i, constants.bounces,
                              constants.emitterPoints);
    sum.light += its.light;
    sum.gloss += its.gloss;
  }
  sum.light /= float(rays * constants.parts);
  sum.gloss /= float(rays * constants.parts);

  uvec2 inside = samplePixel(constants.frameIndex, block.side, block.number);
  uint code = block.side | inside.x << 4 | inside.y << 7 | (at.there ? 0u : 1u << 10);
  if (constants.part > 0u) sum.light += vec3(traced.list[block.place]);
  traced.list[block.place] = vec4(sum.light, float(code));
#if GLOSS
  if (constants.part > 0u) sum.gloss += vec3(tracedGloss.list[block.place]);
  tracedGloss.list[block.place] = vec4(sum.gloss, 0.0);
#endif
  if (wide && constants.part == 0u)
    tiles.list[item & ~kWideItem] = NearFieldTile(at.position, 0u, at.normal, uint(at.there));
  atomicAdd(counters.rays, rayCount);
  atomicAdd(counters.shaded, shadedCount);
  atomicAdd(counters.gathered, gatherCount);
}
