// Shared by the kernels of pass manage: constants, buffers and the density grid. Needs vpls/vpl.glsl.
#ifndef FOVEA_MANAGE_MEMORY_GLSL
#define FOVEA_MANAGE_MEMORY_GLSL

#include "manage/records.h"

layout(push_constant) uniform Constants {
  vec3 gridOrigin;       // of the density grid, world space
  float cellsPerMetre;
  uint slots;            // N, entries of the list
  uint candidateCount;   // M, candidates and failed attempts
  uint listLimit;        // N_MAX <= slots
  uint keepCount;        // K of the thinning; 0 means the number of free slots (placement `light`)
  uint mostRejected;     // most VPLs deleted for failing Eq. 1
  float changeTurnover;  // share of the slots that is replaced when all light is lost
  uint contested;        // VPLs that lose their place although Eq. 1 keeps them
  uint lightFloor64ths;  // in means of the candidates' light
  uint placement;        // parameters of these names
  uint densityConstant64ths;  // CONST
  uint reuse;
  uint randomShare1024ths;    // of the VPLs that `random` reuses; 0: as many as `linear`
  uint order;
  uint maxDensity;
  uint seed;
  uint frameIndex;
};

const uint kReuseLinear = 0u, kReuseCosine = 1u, kReuseRandom = 2u;  // as the choices are declared
const uint kOrderFixed = 1u;
const uint kPlacementLight = 1u;

layout(std430) buffer State { ManageState state; };

const uint kAlive = 1u, kAccepted = 2u;
layout(std430) buffer SlotRecordsBlock { SlotRecord list[]; } slotRecords;

// x: importance, 24 bits, or direct light (placement `light`), kHitNothing if the attempt hit nothing; y: cell
// of the density grid.
const uint kHitNothing = 0xffffffffu;
layout(std430) buffer CandidateRecordsBlock { uvec2 list[]; } candidateRecords;

// Content of a slot: nothing, the VPL that it has, or candidate `source - kFirstCandidate`.
const uint kEmpty = 0u, kKept = 1u, kFirstCandidate = 2u;
layout(std430) coherent buffer SourcesBlock { uint list[]; } sources;

// Lists of (key, index), each followed by the same amount of room to sort into.
layout(std430) coherent buffer ListsBlock { uvec2 entries[]; } lists;
uint candidateList() { return 0u; }                             // Lc: index of a candidate
uint oldList() { return 2u * candidateCount; }                  // L': slot
uint attemptList() { return 2u * (candidateCount + slots); }    // cell, number of the attempt

// Attempts to add, in order: slot, or candidate | kFresh; with kRefused if the cell is full.
const uint kFresh = 0x80000000u, kRefused = 0x40000000u;
layout(std430) coherent buffer AttemptsBlock { uint list[]; } attempts;
layout(std430) coherent buffer AddedBlock { uint list[]; } added;  // candidates, in the order of adding

const uint kOccupied = 0x80000000u;  // there is a VPL or a candidate; the bits below count the reused VPLs
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
