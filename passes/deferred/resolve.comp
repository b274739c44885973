#extension GL_KHR_shader_subgroup_ballot : require
// Combines the subsets into the light of all VPLs: the geometry-aware filter of interleaved sampling, on the
// irradiance only. Defines: INTERLEAVE, MASKED, EDGES, SCALE (see samples.glsl); TRACED 0/1, 1 if rays have found the
// light of some pixels, of which none lies in the periphery; NEAR_FIELD 0/1, 1 if that of pass near-field is to be
// added to it; GLOSS 0/1, 1 to filter also the light that glossy surfaces reflect.
//
// Pixels whose window does not hold all subsets are listed and processed by the EDGES variant, which packs these few
// pixels into its work groups. With MASKED most windows extend beyond the blocks, so EDGES processes all pixels of
// the blocks without a list.
//
// Any window of INTERLEAVE x INTERLEAVE pixels holds each subset once. If all of it lies on the surface of the pixel,
// its mean is the light of all VPLs, with nothing lost. A pixel of the window that lies on another surface leaves its
// subset without a sample. Samples of that subset are then searched on the surface in a window four times as wide;
// those still missing are replaced by the mean of the subsets found, so that edges neither darken nor show a pattern.
// Where fewer than half are found (leaves, chains), other surfaces nearby that face the same way are used as well.
//
// With SCALE 2 the windows are windows of the coarse grid, twice as wide in pixels, and each pixel uses the window
// around the sample of its square. Only the periphery is shaded so, where a quarter of the subsets suffices for a mean.
// Samples of the window on other surfaces that face the same way help out for those missing, and if nothing is found
// at all, as on something thinner than the grid, the whole window does.
//
// MASKED: only the listed blocks of BLOCK x BLOCK pixels were shaded and are filtered here; the other pixels already
// have their irradiance, the base. The part of a pixel's window outside the blocks has no samples, but the base there
// is more accurate anyway. The pixels of the window inside are represented by the mean over all subsets (those
// missing in the window are taken from the pixel's block, or from the base if missing there too), the pixels outside
// by their base. Towards its border a shaded patch thus blends into its surroundings, without the noise of an
// incomplete set of subsets.
#include "device/texels.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"
#include "deferred/records.h"
#if MASKED
#include "deferred/blocks.glsl"
#endif
#include "deferred/samples.glsl"

// Vertically adjacent pixels that an invocation filters together, as their windows overlap.
#if !EDGES
const int kPixels = 4;
#elif MASKED
const int kPixels = kListedColumn;
#else
const int kPixels = 1;
#endif
const uint kSubsets = INTERLEAVE * INTERLEAVE, kEnough = max(kSubsets / (SCALE * SCALE), 1u);
const float kWiderPlane = 8.0, kWiderCos = 0.5;  // bounds of surfaces that may help out

const uint kEdgeGroup = 64u;
#if EDGES
layout(local_size_x = 64) in;
#else
layout(local_size_x = kTileWidth, local_size_y = kTileHeight / kPixels) in;
#endif

// Images rather than textures, because on lavapipe a load from a texture costs several times as much, and loads are
// most of the work.
SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rgba16f) uniform writeonly image2D irradiance;
layout(std430) buffer Counters { uint counters[]; };  // incomplete, -, shaded
#if MASKED
#elif EDGES
uniform usamplerBuffer edges;       // groups x 1 x 1; w: 1 + pixels listed
LARGE_TEXELS(uint, edgePixels);  // x | y << 16
#else
layout(std430) buffer Edges { uint x, y, z, end; } edges;
layout(std430) writeonly buffer EdgePixels { uint list[]; } edgePixels;
#endif

#if MASKED
layout(rgba16f) uniform readonly image2D base;
layout(r8) uniform readonly image2D shadeMask;
#endif

#if TRACED
layout(rgba16f) uniform readonly image2D traced;
#endif
#if TRACED && NEAR_FIELD
layout(rgba16f) uniform readonly image2D nearField;
#endif

layout(push_constant) uniform Constants {
#if !MASKED && !EDGES
  ivec4 fine;           // corners of the part of the picture that is shaded at all pixels
#endif
  float filterPlane;  // tolerance from the tangent plane, relative to the distance from the eye
  float filterCos;    // least cosine between normals
};

// Light of a sample: irradiance / pi, with GLOSS also that under the lobe of glossy surfaces.
#if GLOSS
#define Light mat2x3
layout(rgba16f) uniform writeonly image2D gloss;
Light loadLight(ivec2 at) { return mat2x3(imageLoad(partial, at).rgb, imageLoad(partialGloss, at).rgb); }
#else
#define Light vec3
Light loadLight(ivec2 at) { return imageLoad(partial, at).rgb; }
#endif

struct Weighted {  // a sum of samples, and of their weights
  Light light;
  float weight;
};
const Weighted kNoSamples = Weighted(Light(0.0), 0.0);

void add(inout Weighted sum, Light light, float weight) {
  sum.light += light;
  sum.weight += weight;
}

struct Centre {
  vec3 position, normal;
  Light sum;
  float plane;    // m; below 0: background
  uint found;     // subsets in the sum
#if SCALE > 1
  Weighted others;  // samples on other surfaces that face the same way
#endif
#if MASKED
  vec4 outside;   // rgb: sum of the base over the window's pixels of the surface outside the mask, a: their number
#endif
  uvec2 missing;  // bit per subset, numbered from the pixel: (dy mod INTERLEAVE) * INTERLEAVE + (dx mod INTERLEAVE)
};

#if MASKED
bool isShaded(ivec2 p) { return imageLoad(shadeMask, p).r > 0.5; }
#else
bool isShaded(ivec2 p) { return true; }
#endif

bool sameSurface(Centre c, vec4 position, vec3 normal, float plane, float least) {
  return sameSurface(c.position, c.normal, c.normal, position, normal, plane, least);
}

// What rays have found at a pixel, as it is written; a: 0 if nothing.
vec4 tracedAt(ivec2 p) {
  vec4 found = vec4(0.0);
#if TRACED
  found = imageLoad(traced, p);
#endif
#if TRACED && NEAR_FIELD
  found.rgb = min(found.rgb + imageLoad(nearField, p).rgb, 65504.0);
#endif
  return found;
}

// Bit of a subset in `missing`, numbered from the pixel.
uvec2 subsetBit(ivec2 d) {
  int subset = (d.y + INTERLEAVE) % INTERLEAVE * INTERLEAVE + (d.x + INTERLEAVE) % INTERLEAVE;
  return subset < 32 ? uvec2(1u << subset, 0u) : uvec2(0u, 1u << (subset - 32));
}

Centre centreAt(ivec2 p, ivec2 size) {
  ivec2 inside = min(p, size - 1);
  vec4 position = surfaceAt(inside);
  bool surface = p == inside && position.w > 0.0;
  Centre c;
  c.position = position.xyz;
  c.normal = imageLoad(gbufferNormal, inside).xyz;
  c.sum = Light(0.0);
  c.plane = surface ? filterPlane * position.w : -1.0;
  c.found = 0u;
  c.missing = uvec2(0u);
#if SCALE > 1
  c.others = kNoSamples;
#endif
#if MASKED
  c.outside = vec4(0.0);
#endif
  return c;
}

// Every sample of the windows is loaded once and offered to all centres whose window holds it.
void filterWindows(inout Centre centres[kPixels], ivec2 first) {
  const int kBefore = INTERLEAVE / 2;
  ivec2 size = imageSize(partial), pixels = imageSize(gbufferDistance);
  for (int dx = -kBefore; dx < INTERLEAVE - kBefore; ++dx) {
    for (int row = -kBefore; row < INTERLEAVE - kBefore + (kPixels - 1) / SCALE; ++row) {
      ivec2 q = first / SCALE + ivec2(dx, row);
#if SCALE > 1
      // At the border of the picture, the sample of the same subset on the other side of the window.
      q += INTERLEAVE * (ivec2(lessThan(q, ivec2(0))) - ivec2(greaterThanEqual(q, size)));
#endif
      ivec2 inside = clamp(q, ivec2(0), size - 1), at = samplePixel(inside, pixels);
      vec4 position = surfaceAt(at);
      if (q != inside) position.w = 0.0;
      vec3 normal = imageLoad(gbufferNormal, at).xyz;
      Light value = loadLight(inside);
#if MASKED
      bool shaded = isShaded(inside);
      vec4 known = vec4(imageLoad(base, inside).rgb, 1.0);
#endif
      for (int k = 0; k < kPixels; ++k) {
        int dy = row - k / SCALE;
        if (dy < -kBefore || dy >= INTERLEAVE - kBefore) continue;
        bool same = sameSurface(centres[k], position, normal, centres[k].plane, filterCos);
#if MASKED
        if (same && !shaded) centres[k].outside += known;
        same = same && shaded;
#endif
        if (same) {
          centres[k].sum += value;
          ++centres[k].found;
        } else {
          centres[k].missing |= subsetBit(ivec2(dx, dy));
#if SCALE > 1
          if (sameSurface(centres[k], position, normal, kWiderPlane * centres[k].plane, kWiderCos))
            add(centres[k].others, value, 1.0);
#endif
        }
      }
    }
  }
}

#if SCALE > 1
void addOthers(inout Centre c) {
  c.sum += c.others.light;
  c.found += uint(c.others.weight);
}
#else
void addOthers(inout Centre c) {}
#endif

#if EDGES
// Adds a sample, weighting nearer pixels more.
void addSample(inout Weighted sum, Centre c, ivec2 p, ivec2 d, ivec2 size, float plane, float least) {
  ivec2 q = p + d;
  if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size))) return;
  if (!isShaded(q)) return;
  ivec2 at = samplePixel(q, imageSize(gbufferDistance));
  if (!sameSurface(c, surfaceAt(at), imageLoad(gbufferNormal, at).xyz, plane, least)) return;
  float w = 1.0 / float(max(d.x * d.x + d.y * d.y, 1));
  add(sum, loadLight(q) * w, w);
}

// Removes one subset from the mask and returns it.
int nextSubset(inout uvec2 left, out uvec2 bit) {
  int subset = left.x != 0u ? findLSB(left.x) : 32 + findLSB(left.y);
  bit = subset < 32 ? uvec2(1u << subset, 0u) : uvec2(0u, 1u << (subset - 32));
  left &= ~bit;
  return subset;
}

void take(inout Centre c, Weighted sum, uvec2 bit) {
  if (sum.weight == 0.0) return;
  c.sum += sum.light / sum.weight;
  ++c.found;
  c.missing &= ~bit;
}

// Position of a subset's sample in the window.
ivec2 placeInWindow(ivec2 offset) {
  return offset - INTERLEAVE * ivec2(greaterThanEqual(offset, ivec2(INTERLEAVE - INTERLEAVE / 2)));
}

// The sample of a subset on the other side of the pixel, used where an edge leaves the surface.
Weighted lookAcross(Centre c, ivec2 p, ivec2 offset, ivec2 size, float plane, float least) {
  ivec2 inside = placeInWindow(offset), across = inside + INTERLEAVE * (2 * ivec2(lessThan(inside, ivec2(0))) - 1);
  Weighted sum = kNoSamples;
  addSample(sum, c, p, ivec2(across.x, inside.y), size, plane, least);
  addSample(sum, c, p, ivec2(inside.x, across.y), size, plane, least);
  addSample(sum, c, p, across, size, plane, least);
  return sum;
}

// A sample from anywhere in the wide window, except where it was searched before: of its 4 x 4 samples the
// middle four are the one in the window and those on the other side. window: search the window again if it was
// missing under other bounds.
Weighted lookWider(Centre c, ivec2 p, ivec2 offset, ivec2 size, float plane, float least, bool window) {
  ivec2 first = offset - 2 * INTERLEAVE;
  Weighted sum = kNoSamples;
  for (int i = 0; i < 12; ++i) {
    int place = i < 4 ? i : i < 8 ? 4 * (i / 2 - 1) + 3 * (i & 1) : i + 4;
    addSample(sum, c, p, first + INTERLEAVE * ivec2(place & 3, place >> 2), size, plane, least);
  }
  if (window) addSample(sum, c, p, placeInWindow(offset), size, plane, least);
  return sum;
}

// Searches the missing subsets of a `wanted` pixel; those found are removed from the mask. Every invocation searches
// for its own pixel: dividing the searches among the lanes of a subgroup saves nothing measurable on a CPU device, and
// a driver of NVIDIA (580.159) loses samples of pixels at edges when lanes exchange them.
void search(inout Centre c, ivec2 p, ivec2 size, float plane, float least, bool wanted, bool across, bool window) {
  uvec2 left = wanted ? c.missing : uvec2(0u), bit;
  while (left != uvec2(0u)) {
    int subset = nextSubset(left, bit);
    ivec2 offset = ivec2(subset % INTERLEAVE, subset / INTERLEAVE);
    take(c,
         across ? lookAcross(c, p, offset, size, plane, least) : lookWider(c, p, offset, size, plane, least, window),
         bit);
  }
}

#if MASKED
// Samples of missing subsets from the pixel's own block. Those that are also in the window have been tried already.
void searchBlock(inout Centre c, ivec2 p, ivec2 size) {
  ivec2 corner = p / BLOCK * BLOCK;
  for (int i = 0; i < BLOCK * BLOCK; ++i) {
    ivec2 q = corner + ivec2(i % BLOCK, i / BLOCK), d = q - p;
    bool inWindow = all(greaterThanEqual(d, ivec2(-INTERLEAVE / 2))) &&
                    all(lessThan(d, ivec2(INTERLEAVE - INTERLEAVE / 2)));
    uvec2 bit = subsetBit((d + BLOCK) % INTERLEAVE);
    bool wanted = c.outside.a > 0.0 && !inWindow && all(lessThan(q, size)) && (c.missing & bit) != uvec2(0u);
    if (wanted && sameSurface(c, surfaceAt(q), imageLoad(gbufferNormal, q).xyz, c.plane, filterCos)) {
      c.sum += loadLight(q);
      ++c.found;
      c.missing &= ~bit;
    }
  }
}
#endif

#if SCALE > 1
Light lastResort(ivec2 p, ivec2 size) {
  Light sum = Light(0.0);
  for (uint i = 0u; i < kSubsets; ++i)
    sum += loadLight(clamp(p + placeInWindow(ivec2(i % INTERLEAVE, i / INTERLEAVE)), ivec2(0), size - 1));
  return sum / float(kSubsets);
}
#else
Light lastResort(ivec2 p, ivec2 size) { return loadLight(p); }  // its normal has length 0, or is NaN
#endif

// The mean over the subsets, and whether fewer than half of them were found on the surface. p: the sample around which
// the window lies; size: of the grid. Pixels that are not `wanted` search for nothing.
Light meanOfSubsets(inout Centre c, ivec2 p, ivec2 size, bool wanted, out bool incomplete) {
  incomplete = false;
  bool based = false;
#if MASKED
  float inWindow = float(c.found);
  based = c.outside.a > 0.0;
  searchBlock(c, p, size);
  if (based) {
    c.missing = uvec2(0u);  // the base also stands in for those that are neither in the window nor in the block
  }
#endif
  float plane = c.plane, least = filterCos;
  // `again` uses wider bounds. The loop ends at its head, see weight-map/scatter.comp.
  bool searches = wanted, again = false;
  while (searches) {
    search(c, p, size, plane, least, searches, true, false);
    search(c, p, size, plane, least, searches, false, again);
    bool few = wanted && 2u * c.found < kSubsets;
    incomplete = incomplete || few;
    searches = few && !again && !based;
    again = true;
    plane *= kWiderPlane;
    least = kWiderCos;
  }
  if (c.found == 0u) {
    c.sum = lastResort(p, size);
    c.found = 1u;
  }
#if MASKED
  if (based) {
    vec3 inside = (c.sum + float(kSubsets - c.found) * c.outside.rgb / c.outside.a) / float(kSubsets);
    return (inWindow * inside + c.outside.rgb) / (inWindow + c.outside.a);
  }
#endif
  return c.sum / float(c.found);
}
#endif

// Writes the light of a pixel. known: what rays have found there, if a is above 0.
void store(ivec2 p, Light light, vec4 known) {
#if GLOSS
  imageStore(gloss, p, vec4(light[1], 1.0));
  vec3 mean = light[0];
#else
  vec3 mean = light;
#endif
  imageStore(irradiance, p, known.a > 0.0 ? known : vec4(mean, 1.0));
}

#if EDGES
#if MASKED
const int kItems = kListedColumns;
ivec2 itemAt(int k, ivec2 size) { return listedColumn(k, size); }
#else
const int kItems = 1;
ivec2 itemAt(int k, ivec2 size) {
  uint item = gl_GlobalInvocationID.x;
  if (item + 1u >= texelFetch(edges, 0).w) return size;
  uint where = texelOf(edgePixels, int(item)).x;
  return ivec2(where & 0xffffu, where >> 16u);
}
#endif

void main() {
  ivec2 size = imageSize(gbufferDistance);
  uint surfaces = 0u, found = 0u;
  for (int k = 0; k < kItems; ++k) {
    ivec2 first = itemAt(k, size);  // past the end of the list: `size`
    Centre centres[kPixels];
    for (int i = 0; i < kPixels; ++i) centres[i] = centreAt(first + ivec2(0, i), size);
    filterWindows(centres, first);
    for (int i = 0; i < kPixels; ++i) {
      ivec2 p = first + ivec2(0, i);
      bool surface = centres[i].plane >= 0.0, incomplete;
      Light mean = meanOfSubsets(centres[i], min(p, size - 1) / SCALE, imageSize(partial), surface, incomplete);
      if (all(lessThan(p, size))) store(p, surface ? mean : Light(0.0), tracedAt(min(p, size - 1)));
      surfaces += subgroupBallotBitCount(subgroupBallot(surface));
      found += subgroupBallotBitCount(subgroupBallot(incomplete));
    }
  }
  if (subgroupElect() && found > 0u) atomicAdd(counters[0], found);
#if MASKED
  if (subgroupElect() && surfaces > 0u) atomicAdd(counters[2], surfaces);
#endif
}
#else
// Filters kPixels pixels from `first` downwards and writes them, or lists them. Returns how many pixels of the
// subgroup show a surface.
uint resolve(ivec2 first, ivec2 size) {
  Centre centres[kPixels];
  for (int k = 0; k < kPixels; ++k) centres[k] = centreAt(first + ivec2(0, k), size);
  filterWindows(centres, first);
  for (int k = 0; k < kPixels; ++k) addOthers(centres[k]);
  vec4 known[kPixels];
  for (int k = 0; k < kPixels; ++k) known[k] = tracedAt(min(first + ivec2(0, k), size - 1));
  uint surfaces = 0u, total = 0u, before[kPixels];
  for (int k = 0; k < kPixels; ++k) {
    bool surface = centres[k].plane >= 0.0;
    surfaces += subgroupBallotBitCount(subgroupBallot(surface));
    uvec4 edge = subgroupBallot(surface && centres[k].found < kEnough && known[k].a == 0.0);
    before[k] = total + subgroupBallotExclusiveBitCount(edge);
    total += subgroupBallotBitCount(edge);
  }
  uint end = 0u;
  if (subgroupElect() && total > 0u) end = atomicAdd(edges.end, total);
  end = subgroupBroadcastFirst(end);
  if (subgroupElect() && total > 0u) atomicMax(edges.x, (end + total + kEdgeGroup - 2u) / kEdgeGroup);
  for (int k = 0; k < kPixels; ++k) {
    ivec2 p = first + ivec2(0, k);
    bool surface = centres[k].plane >= 0.0;
    if (surface && centres[k].found < kEnough && known[k].a == 0.0)
      edgePixels.list[end - 1u + before[k]] = uint(p.x) | uint(p.y) << 16u;
    else if (all(lessThan(p, size))) {
      store(p, surface ? centres[k].sum / float(max(centres[k].found, 1u)) : Light(0.0), known[k]);
    }
  }
  return surfaces;
}

void main() {
  ivec2 size = imageSize(gbufferDistance);
  ivec2 corner = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy * uvec2(1, kPixels));
  // Groups lie in one of the two parts as a whole.
  if ((all(greaterThanEqual(corner, fine.xy)) && all(lessThan(corner, fine.zw))) != (SCALE == 1)) return;
  uint surfaces = resolve(corner + ivec2(gl_LocalInvocationID.x, gl_LocalInvocationID.y * kPixels), size);
  surfaces /= SCALE * SCALE;
  if (subgroupElect() && surfaces > 0u) atomicAdd(counters[2], surfaces);
}
#endif
