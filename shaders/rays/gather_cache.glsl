// A cache of the light that is gathered at surfaces, in cells of space: path space filtering with a hash table (Binder
// et al., "Massively Parallel Path Space Filtering", 2019). The samples of a frame become part of the cells at its end,
// so that it does not matter which of them comes first. Only where the table is so full that a cell finds none of its
// places free do results depend on that.
//
// Define: RAY_PASSAGE (rays/trace.glsl).
//
// Needs the port `cells`, a buffer of kGatherCells GatherCells that the pass keeps, and a last step that calls
// mergeSamples() for each of them.
#ifndef FOVEA_RAYS_GATHER_CACHE_GLSL
#define FOVEA_RAYS_GATHER_CACHE_GLSL

#include "device/sums.glsl"
#include "rays/gather.glsl"
#include "records/gather_cache.h"

LIST(restrict, GatherCell, cells);  // records/gather_cache.h

uint gatherCount = 0u;  // how often this invocation has gathered light

// A cell by its hash.
struct CellName {
  uint key;    // never 0
  uint first;  // its places in the table follow this one
};

// The cell of a point on a surface, world space, m. normal: unit; surfaces that face along different axes have
// different cells. jitter: in [-0.5, 0.5) for each axis, by which the point is moved in widths of a cell, so that the
// borders of cells do not show. width: of cells, m, rounded down to a power of two.
CellName cellOf(vec3 position, vec3 normal, vec3 jitter, float width) {
  vec3 size = abs(normal);
  int axis = size.x >= max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  int side = 2 * axis + int(normal[axis] < 0.0), level = int(clamp(floor(log2(width)), -30.0, 30.0));
  ivec3 place = ivec3(clamp(floor(position * exp2(float(-level)) + jitter), -1e9, 1e9));
  uint name = hashCombine(hashCombine(hashCombine(uint(side | (level + 32) << 3), uint(place.x)), uint(place.y)),
                          uint(place.z));
  return CellName(max(hashPcg(name), 1u), hashCombine(name, 1u));
}

// The place of a cell, or kGatherCells if it has none.
uint findCell(CellName cell) {
  for (uint i = 0u; i < kGatherPlaces; ++i) {
    uint place = (cell.first + i) % kGatherCells;
    if (cells.list[place].key == cell.key) return place;
  }
  return kGatherCells;
}

// The same, but a cell without a place gets one if one is free. While samples are added, no place becomes free, so that
// invocations that want the same cell at the same time agree on the first one.
uint claimCell(CellName cell) {
  uint found = findCell(cell);
  for (uint i = 0u; i < kGatherPlaces && found == kGatherCells; ++i) {
    uint place = (cell.first + i) % kGatherCells;
    uint before = atomicCompSwap(cells.list[place].key, 0u, cell.key);
    if (before == 0u || before == cell.key) found = place;
  }
  return found;
}

// Adds a sample to a cell. light: radiance, W/(sr m^2).
void addToCell(CellName cell, vec3 light) {
  uint place = claimCell(cell);
  if (place == kGatherCells) return;
  light = min(light, kMostGatheredLight);
  atomicAdd(cells.list[place].samples, 1u);
  ADD_TO_SUM(cells.list[place].red, cells.list[place].redHigh, light.r);
  ADD_TO_SUM(cells.list[place].green, cells.list[place].greenHigh, light.g);
  ADD_TO_SUM(cells.list[place].blue, cells.list[place].blueHigh, light.b);
}

// What the n samples of a cell are worth after the light has changed: n / (1 + n ageing).
float agedWeight(GatherCell cell, float ageing) { return cell.weight / (1.0 + cell.weight * ageing); }

// Makes the samples of this frame part of the cell at a place, and frees the place if there have been none for
// kMostIdle frames. ageing: as in agedWeight().
void mergeSamples(uint place, float ageing) {
  GatherCell cell = cells.list[place];
  if (cell.key == 0u) return;
  float now = float(cell.samples);
  float before = min(agedWeight(cell, ageing), max(kMostGathered - now, 0.0));
  if (cell.samples > 0u) {
    vec3 sum = vec3(sumOf(cell.red, cell.redHigh), sumOf(cell.green, cell.greenHigh),
                    sumOf(cell.blue, cell.blueHigh));
    cell.light = (cell.light * before + sum) / (before + now);
  }
  cell.idle = cell.samples > 0u ? 0u : cell.idle + 1u;
  cell.weight = min(before + now, kMostGathered);
  if (cell.idle >= kMostIdle) cell.key = 0u, cell.weight = 0.0;
  cell.samples = cell.red = cell.redHigh = cell.green = cell.greenHigh = cell.blue = cell.blueHigh = 0u;
  cells.list[place] = cell;
}

// What gather() finds at v with one ray, W/(sr m^2), from the cache where enough is known. stream: of random numbers;
// width: of the cells, m; ageing: as in agedWeight().
vec3 gatheredLight(TracedSurface v, uint bounces, uint stream, float width, float ageing) {
  vec3 jitter = vec3(uniformFloat(randomStream(stream, 0u, kCellStream, 0u)),
                     uniformFloat(randomStream(stream, 1u, kCellStream, 0u)),
                     uniformFloat(randomStream(stream, 2u, kCellStream, 0u))) - 0.5;
  CellName cell = cellOf(v.position, v.face, jitter, width);
  uint place = findCell(cell);
  bool known = place != kGatherCells && agedWeight(cells.list[place], ageing) >= kEnoughGathered;
  vec3 light = known ? cells.list[place].light : vec3(0.0);
  if (known && uniformFloat(randomStream(stream, 3u, kCellStream, 0u)) >= kGatheredAnew) return light;
  ++gatherCount;
  vec3 gathered = gather(v, bounces, 1u, stream);
  addToCell(cell, gathered);
  return known ? light : gathered;
}

#endif
