// How probes are laid out in space and in their images. Directions are unit; side is the width of a tile without its
// border, in texels.
#ifndef FOVEA_PROBES_GLSL
#define FOVEA_PROBES_GLSL

#include "scene/octahedral.glsl"
#include "records/probes.h"

// Number of probes in the grid.
int probesOf(ProbeGrid grid) { return int(grid.columns * grid.rows * grid.layers); }

// Number of the probe in a cell of the grid.
int probeAt(ProbeGrid grid, ivec3 cell) {
  return cell.x + int(grid.columns) * (cell.y + int(grid.rows) * cell.z);
}

// The cell of a probe.
ivec3 probeCell(ProbeGrid grid, int probe) {
  int columns = int(grid.columns), rows = int(grid.rows);
  return ivec3(probe % columns, probe / columns % rows, probe / columns / rows);
}

// The greatest distance that probes remember, m.
float probeReach(ProbeGrid grid) { return kProbeReach * sqrt(3.0) * grid.spacing; }

// The state of a probe. probes: the member `states` of the bundle `probes`.
Probe loadProbe(samplerBuffer probes, int probe) {
  vec4 a = texelFetch(probes, 2 * probe), b = texelFetch(probes, 2 * probe + 1);
  return Probe(vec3(a), a.w, b.x, b.y, b.z, b.w);
}

// Weight of the history of a probe that has gathered light for so many frames. The first frames count less than in a
// plain mean, as light has one bounce more in each of them.
float keptAfter(float frames, float hysteresis) { return min(hysteresis, frames / (frames + kSettling)); }

// First texel of a probe's tile of side x side texels and their border.
ivec2 probeTile(int probe, int side) {
  return (side + 2) * ivec2(probe % kProbeTilesInARow, probe / kProbeTilesInARow);
}

// The probe in whose tile a texel lies.
int probeOfTexel(ivec2 texel, int side) {
  ivec2 tile = texel / (side + 2);
  return tile.x + kProbeTilesInARow * tile.y;
}

// Direction for which a texel of a tile stands. A texel of the border stands for the same as the one on the other side
// of the octahedron's edge.
vec3 probeDirection(ivec2 texel, int side) {
  ivec2 t = texel % (side + 2) - 1;
  if (t.x < 0 || t.x >= side) t = ivec2(clamp(t.x, 0, side - 1), side - 1 - t.y);
  if (t.y < 0 || t.y >= side) t = ivec2(side - 1 - t.x, clamp(t.y, 0, side - 1));
  return octDecode((2.0 * vec2(t) + 1.0) / float(side) - 1.0);
}

// Place of a direction in a probe's tile, in texels of the image from the centre of its first one.
vec2 probePlace(int probe, int side, vec3 direction) {
  return vec2(probeTile(probe, side)) + 0.5 + (0.5 * octEncode(direction) + 0.5) * float(side);
}

#endif
