// What the kernels of pass manage share: constants, memory of the pass, the density grid.
// Needs common/vpl.glsl.
#ifndef FOVEA_MANAGE_MEMORY_GLSL
#define FOVEA_MANAGE_MEMORY_GLSL

layout(push_constant) uniform Constants {
  vec3 gridOrigin;       // of the density grid, world space
  float cellsPerMetre;
  uint slots;            // N, entries of the list
  uint candidateCount;   // M, candidates and failed attempts
  uint listLimit;        // N_MAX <= slots
  uint keepCount;        // K of the thinning; 0: the slots that are free (placement `light`)
  uint mostRejected;     // VPLs that Eq. 1 takes away at most
  uint lightFloor64ths;  // of the mean light
  uint placement;        // parameters of these names
  uint densityConstant64ths;  // CONST
  uint reuse;
  uint order;
  uint maxDensity;
  uint seed;
  uint frameIndex;
};

const uint kReuseLinear = 0u, kReuseCosine = 1u, kReuseRandom = 2u;  // as the choices are declared
const uint kOrderFixed = 1u;
const uint kPlacementLight = 1u;

layout(std430) buffer StateBlock {
  uint occupied;        // cells that hold a VPL or a candidate
  uint alive;           // VPLs at the start
  uint accepted;        // of them: by Eq. 1
  uint reused;          // of them: in the new list
  uint oldCount;        // |L'|
  uint candidateCount;  // |Lc|
} state;

struct SlotRecord {
  uint importance;  // 24 bits
  uint flags;
  uint cell;        // of the density grid
  uint key;         // 24 bits: the order in which VPLs are reused, least first
};
const uint kAlive = 1u, kAccepted = 2u;
layout(std430) buffer SlotRecordsBlock { SlotRecord list[]; } slotRecords;

// x: importance, 24 bits, or direct light (placement `light`); kNoCandidate: an attempt that hit nothing; y: cell of the density grid.
const uint kNoCandidate = 0xffffffffu;
layout(std430) buffer CandidateRecordsBlock { uvec2 list[]; } candidateRecords;

// What a slot gets: nothing, the VPL it has, or candidate `source - kFirstCandidate`.
const uint kEmpty = 0u, kKept = 1u, kFirstCandidate = 2u;
layout(std430) coherent buffer SourcesBlock { uint list[]; } sources;

// Lists of (key, index), each with as much room again behind it to sort into.
layout(std430) coherent buffer ListsBlock { uvec2 entries[]; } lists;
uint candidateList() { return 0u; }                             // Lc: index of a candidate
uint oldList() { return 2u * candidateCount; }                  // L': slot
uint attemptList() { return 2u * (candidateCount + slots); }    // cell, number of the attempt

// Attempts to add, in order: slot, or candidate | kFresh; | kRefused: its cell is full.
const uint kFresh = 0x80000000u, kRefused = 0x40000000u;
layout(std430) coherent buffer AttemptsBlock { uint list[]; } attempts;
layout(std430) coherent buffer AddedBlock { uint list[]; } added;  // candidates, in the order of adding

// Density grid, 64^3 cells that repeat in space: a hash without collisions inside the scene, whose longest edge is at most
// as long as 64 cells, and a place for VPLs outside.
const uint kCellBits = 18u;
const uint kOccupied = 0x80000000u;  // a VPL or a candidate is there; the bits below count the VPLs that are reused
layout(std430) buffer DensityBlock { uint cells[]; } density;
layout(std430) coherent buffer SegmentsBlock { uint first[]; } segments;  // per cell, in the sorted attempts

layout(std430) buffer CountersBlock { uint kept, deleted, added, candidates, rejected, alive, dense; } counters;

uint axisCell(float x) { return x > -1e6 && x < 1e6 ? uint(int(floor(x))) & 63u : 0u; }
uint cellOf(vec3 position) {
  precise vec3 p = (position - gridOrigin) * cellsPerMetre;
  return axisCell(p.x) | axisCell(p.y) << 6 | axisCell(p.z) << 12;
}
uint densityAt(uint cell) { return density.cells[cell] & ~kOccupied; }

#endif
