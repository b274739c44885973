// A plain CPU version of pass vpl-intensity (passes/vpls.md, vpl-intensity), and a room to run it in.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/passes/ray_reference.h"
#include "tests/references/fovea.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_trace.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {

// What an eye in the scene sees, one entry per pixel.
struct Seen {
  glm::vec3 position{0}, normal{0};
  bool there = false;
};

struct Room {
  scene::Scene scene;
  scene::Geometry geometry;
  VoxelArrays voxels;
  glm::ivec2 size{0};
  std::vector<Seen> pixels;
  scene::PixelRays camera;
  scene::Voxels view() const { return {voxels.grid, voxels.index, voxels.surface}; }
};

inline Room lookInto(scene::Scene scene, int resolution, glm::ivec2 size, float verticalFov = 0.8f) {
  Room room;
  scene::Camera camera;
  camera.verticalFov = verticalFov;
  room.scene = std::move(scene);
  room.scene.cameras = {camera};
  room.geometry = scene::flatten(room.scene);
  room.voxels = voxelizeReference(room.scene, room.geometry, resolution);
  room.size = size;
  const scene::View view = scene::makeView(camera, size, room.geometry);
  room.camera = scene::pixelRays(view);
  for (int i = 0; i < size.x * size.y; ++i) {
    const glm::dvec3 d = view.rayDirection(glm::vec2(i % size.x, i / size.x) + 0.5f);
    const RayHit hit = castRay(room.scene, room.geometry, view.eye, d);
    Seen seen;
    if (hit) {
      const glm::dvec3 n = faceNormal(room.geometry, hit.triangle);
      seen = {glm::vec3(glm::dvec3(view.eye) + hit.t * d), glm::vec3(glm::dot(n, d) < 0 ? n : -n), true};
    }
    room.pixels.push_back(seen);
  }
  return room;
}

// A closed room of 4 m, optionally with a block in it. The camera stands in the middle and looks along -z.
inline Room closedRoom(bool block, int resolution = 24, glm::ivec2 size = glm::ivec2(64),
                       float verticalFov = 0.8f) {
  scene::Scene s;
  const uint32_t material = addMaterial(s, glm::vec3(0.5f)), walls[6] = {};
  addRoom(s, walls, 2);
  if (block) addBox(s, material, {-1.1f, -2, -1.6f}, {0.2f, -0.4f, -0.7f});
  return lookInto(std::move(s), resolution, size, verticalFov);
}

inline glm::vec2 sequencePoint(uint32_t i) {
  return {uniformFloat(0x80000000u + i * 3242174889u), uniformFloat(0x80000000u + i * 2447445414u)};
}

struct WeightSettings {
  uint32_t region = scene::kRegionFovea;
  double imageShare = 0.4;  // of region `mixed`
  float foveaRadius = 0.25f;
  uint32_t points = 1024;
  double areaCap = 4, normalWeight = 0.5;
  bool litOnly = true;
  double clamp = 0;  // m; 0 if the kernel is `disc`
  glm::vec2 gaze{0.5f};
};

inline std::vector<Seen> screenPoints(const Room& room, const WeightSettings& settings) {
  const glm::vec2 high(room.size);
  const scene::Fovea fovea = scene::makeFovea(settings.gaze, high, settings.foveaRadius);
  const glm::vec2 low = glm::max(glm::vec2(0), fovea.centre - fovea.radius),
                  up = glm::min(high, fovea.centre + fovea.radius);
  std::vector<Seen> points;
  uint32_t counts[2] = {}, due = 0;  // samples of the fovea, of the image; 64ths of the next one of the image
  for (uint32_t i = 0; i < settings.points; ++i) {
    glm::ivec2 pixel(-1);
    const bool mixed = settings.region == scene::kRegionMixed;
    due += uint32_t(std::lround(64 * settings.imageShare));
    const bool image = mixed ? due >= 64 : settings.region == scene::kRegionImage;
    due %= 64;
    const uint32_t number = counts[image]++;
    if (image) pixel = glm::ivec2(high * sequencePoint(number));
    for (uint32_t k = 0; pixel.x < 0 && k < scene::kRegionTries; ++k) {
      const glm::vec2 p = glm::mix(low, up, sequencePoint(number + k * settings.points));
      const bool inside =
          glm::all(glm::greaterThanEqual(up, low)) && glm::distance(p, fovea.centre) <= fovea.radius;
      if (inside) pixel = glm::ivec2(p);
    }
    if (pixel.x < 0)
      pixel =
          scene::regionSample(scene::kRegionFovea, fovea, room.size, randomStream(0, 0, 0x77656967u, number));
    pixel = glm::clamp(pixel, glm::ivec2(0), room.size - 1);
    points.push_back(room.pixels[size_t(pixel.y) * room.size.x + pixel.x]);
  }
  return points;
}

// Paraboloid maps of the VPLs, slot after slot, as pass shadow-atlas draws them.
struct Maps {
  int size = 4;
  std::vector<uint32_t> texels;
};

// Maps in which nothing hides anything, for rooms without a block.
inline Maps emptyMaps(size_t vpls) { return {4, std::vector<uint32_t>(16 * vpls, scene::kParaboloidEmpty)}; }

inline Maps tracedMaps(const Room& room, const std::vector<scene::VplState>& vpls, int size = 32) {
  Maps maps{size, {}};
  for (const scene::VplState& vpl : vpls) {
    const glm::mat3 frame = scene::orthonormalFrame(vpl.life > 0 ? vpl.normal : glm::vec3(0, 0, 1));
    for (int i = 0; i < size * size; ++i) {
      const glm::vec3 d = scene::paraboloidTexelDirection({i % size, i / size}, size);
      RayHit hit;
      if (d.z > 0 && vpl.life > 0)
        hit = castRay(room.scene, room.geometry, vpl.position, scene::toWorld(frame, d), {.tMin = 1e-3});
      const float t = hit ? float(hit.t) : std::numeric_limits<float>::infinity();
      maps.texels.emplace_back();
      std::memcpy(&maps.texels.back(), &t, sizeof t);
    }
  }
  return maps;
}

// The comparison of pass deferred: the map's distance with that of the point's tangent plane along the direction of
// the texel's centre.
inline bool seesVpl(const Maps& maps, const Seen& s, const scene::VplState& vpl, size_t slot) {
  const glm::mat3 frame = scene::orthonormalFrame(vpl.normal);
  const glm::vec3 local = scene::toLocal(frame, s.position - vpl.position),
                  face = scene::toLocal(frame, s.normal);
  const float len = glm::length(local);
  const glm::ivec2 texel = scene::paraboloidTexel(scene::paraboloidProject(local, len), maps.size);
  float stored;
  std::memcpy(&stored, &maps.texels[(slot * maps.size + texel.y) * maps.size + texel.x], sizeof stored);
  const float facing = -glm::dot(face, scene::paraboloidTexelDirection(texel, maps.size));
  const float plane = facing > 1e-3f ? -glm::dot(face, local) / facing : len;
  return stored >= std::min(plane, len) - (0.5f * (len + local.z) * (2.0f / float(maps.size)) + 1e-3f);
}

// What a point gets from a VPL per area and radiosity, 1/m^2; 0 if it does not see the VPL. area is that of the disc
// with which the VPL emits.
inline double seenTerm(const Seen& s, const scene::VplState& vpl, const Maps& maps, size_t slot, double area,
                       float clamp) {
  if (!(vpl.life > 0) || !s.there) return 0;
  const glm::dvec3 to = glm::dvec3(vpl.position) - glm::dvec3(s.position);
  const double d2 = glm::dot(to, to);
  const double cosines = std::max(glm::dot(glm::dvec3(s.normal), to), 0.0) *
                         std::max(-glm::dot(glm::dvec3(vpl.normal), to), 0.0);
  if (!(cosines > 1e-12 * d2 && d2 > 1e-12) || !seesVpl(maps, s, vpl, slot)) return 0;
  const double pi = glm::pi<double>();
  return cosines / (d2 * (clamp > 0 ? pi * std::max(d2, double(clamp) * clamp) : pi * d2 + area));
}

// What the region gets from each slot per area and radiosity, 1/m^2. areas are those of the discs with which the VPLs
// shine; if there are none, those of a cell. With a clamp it is at least half of what the region gets without.
// seenFrom is the number of points that each value is an average of.
inline std::vector<double> seenDensities(const Room& room, const std::vector<scene::VplState>& vpls,
                                         const std::vector<Seen>& points, const Maps& maps, float clamp = 0,
                                         const std::vector<double>* areas = nullptr,
                                         std::vector<double>* seenFrom = nullptr) {
  const float cell = room.voxels.grid.cell;
  std::vector<double> result;
  for (size_t slot = 0; slot < vpls.size(); ++slot) {
    double sum = 0, squares = 0, open = 0;
    for (const Seen& s : points) {
      const double area = areas ? (*areas)[slot] : double(cell) * cell;
      const double term = seenTerm(s, vpls[slot], maps, slot, area, clamp);
      sum += term;
      squares += term * term;
      if (clamp > 0) open += seenTerm(s, vpls[slot], maps, slot, area, 0);
    }
    result.push_back(std::max(sum, open / 2) / double(points.size()));
    if (seenFrom) seenFrom->push_back(squares > 0 ? sum * sum / squares : 0);
  }
  return result;
}

// Whether no side of a voxel along the way blocks. A side blocks if it faces the ray and lies in front of the start's
// tangent plane, neither within 1.5 cells of the VPL nor within one of its tangent plane and turned the same way.
// Every cell is tested.
inline bool seesVpl(const scene::Voxels& voxels, const Seen& from, const scene::VplState& vpl) {
  const glm::vec3 to = vpl.position - from.position, p = voxels.grid.worldToVoxel(from.position);
  const float d = glm::length(to), cell = voxels.grid.cell;
  const glm::vec3 direction = to / d;
  auto blocks = [&](const scene::VoxelSide& side) {
    const glm::vec3 off = side.position - vpl.position;
    return side.area > 0 && glm::dot(side.normal, direction) < 0 &&
           glm::dot(side.position - from.position, from.normal) > scene::kOwnSurface * cell &&
           glm::length(off) >= 1.5f * cell &&
           !(glm::dot(side.normal, vpl.normal) > 0.5f && std::abs(glm::dot(off, vpl.normal)) < cell);
  };
  float t = 0;
  while (t < d / cell - 1) {
    const glm::ivec3 at = glm::ivec3(glm::floor(p + (t + 1e-3f) * direction));
    if (!voxels.inside(at)) break;
    const uint32_t voxel = voxels.at(at);
    if (voxel != 0 && (blocks(voxels.surface[2 * voxel - 2]) || blocks(voxels.surface[2 * voxel - 1])))
      return false;
    float next = 1e30f;
    for (int k = 0; k < 3; ++k)
      if (std::abs(direction[k]) > 1e-7f)
        next = std::min(next, (float(at[k]) + (direction[k] > 0 ? 1.0f : 0.0f) - p[k]) / direction[k]);
    t = std::max(t, next);
  }
  return true;
}

// p_A of each slot, 1/m^2. Lane i of 64 sums every 64th point and tests one of them, drawn in proportion to the terms.
inline std::vector<double> densities(const Room& room, const std::vector<scene::VplState>& vpls,
                                     const std::vector<Seen>& points) {
  const scene::Voxels voxels = room.view();
  const float cell = voxels.grid.cell;
  std::vector<double> result;
  for (uint32_t slot = 0; slot < vpls.size(); ++slot) {
    const scene::VplState& vpl = vpls[slot];
    const auto landing = [&](const Seen& s) {
      const glm::vec3 to = vpl.position - s.position;
      const float d2 = glm::dot(to, to);
      const float cosines =
          std::max(glm::dot(s.normal, to), 0.0f) * std::max(-glm::dot(vpl.normal, to), 0.0f);
      const bool counts = vpl.life > 0 && s.there && cosines > 1e-12f * d2 && d2 > 1e-12f;
      const float solid = glm::pi<float>() * d2 + cell * cell;
      return counts ? cosines / (d2 * solid) : 0.0f;
    };
    double total = 0;
    for (uint32_t lane = 0; lane < 64; ++lane) {
      float sum = 0, reached = 0;
      for (size_t i = lane; i < points.size(); i += 64) sum += landing(points[i]);
      if (!(sum > 0)) continue;
      const float target = sum * uniformFloat(randomStream(0, 0, 0x64656e73u, 64 * slot + lane));
      size_t chosen = lane;
      for (size_t i = lane; i < points.size(); i += 64) {
        const float term = landing(points[i]);
        if (term > 0 && reached <= target) chosen = i;
        reached += term;
      }
      if (seesVpl(voxels, points[chosen], vpl)) total += sum;
    }
    result.push_back(total / double(points.size()));
  }
  return result;
}

// Attempts per hit on a surface, with one diffuse bounce from each of the first 1024 points.
inline double escaping(const Room& room, const std::vector<Seen>& points) {
  const uint32_t tried = std::min(uint32_t(points.size()), 1024u);
  uint32_t found = 0;
  for (uint32_t i = 0; i < tried; ++i) {
    if (!points[i].there) continue;
    const glm::vec2 u = scene::streamPoint(randomStream(0, 0, 0x65736361u, i), 0);
    const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
    const glm::vec3 local(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x));
    const glm::vec3 direction = scene::toWorld(scene::orthonormalFrame(points[i].normal), local);
    found += scene::traceVoxels(room.view(), points[i].position, direction, points[i].normal).side !=
             scene::kNoSide;
  }
  return found > 0 ? double(tried) / found : 1;
}

// escaping is the number of attempts per hit on a surface.
inline double leastDensity(const std::vector<double>& p, double areaCap) {
  std::vector<double> seen;
  for (const double x : p)
    if (x > 0) seen.push_back(x);
  std::sort(seen.begin(), seen.end());
  return seen.empty() ? 0 : seen[(seen.size() + 1) / 2 - 1] / areaCap;
}

inline std::vector<double> pdfAreas(const std::vector<scene::VplState>& vpls, const std::vector<double>& p,
                                    double areaCap, double escaping) {
  std::vector<double> areas;
  double alive = 0;
  for (const scene::VplState& vpl : vpls) alive += vpl.life > 0;
  const double least = leastDensity(p, areaCap);
  for (size_t i = 0; i < vpls.size(); ++i)
    areas.push_back(vpls[i].life > 0 && least > 0 ? 1 / (alive * escaping * std::max(p[i], least)) : 0);
  return areas;
}

inline double normalLambda(const Room& room, double normalWeight) {
  const glm::dvec3 extent = room.geometry.boundsMax - room.geometry.boundsMin;
  double surface = 0;
  for (const scene::VoxelSide& side : room.voxels.surface) surface += side.area;
  const double path = surface > 0 ? 4 * extent.x * extent.y * extent.z / surface : 0;
  return normalWeight * path * path;
}

// Area of the sides nearest to each VPL, found by trying every VPL. `doubtful` is the area of the sides that two VPLs
// are equally near to.
inline std::vector<double> voronoiAreas(const Room& room, const std::vector<scene::VplState>& vpls,
                                        const std::vector<glm::vec4>& radiance,
                                        const WeightSettings& settings, double* doubtful) {
  std::vector<double> areas(vpls.size(), 0.0);
  const double lambda = normalLambda(room, settings.normalWeight);
  *doubtful = 0;
  for (size_t s = 0; s < room.voxels.surface.size(); ++s) {
    const scene::VoxelSide& side = room.voxels.surface[s];
    if (!(side.area > 0) || (settings.litOnly && !(radiance[s].w > 0))) continue;
    double best = 1e300, second = 1e300;
    size_t owner = 0;
    for (size_t i = 0; i < vpls.size(); ++i) {
      if (!(vpls[i].life > 0) || (settings.litOnly && !(radiance[vpls[i].side].w > 0))) continue;
      const glm::dvec3 d = glm::dvec3(vpls[i].position) - glm::dvec3(side.position);
      const double cost =
          glm::dot(d, d) + lambda * (1 - glm::dot(glm::dvec3(side.normal), glm::dvec3(vpls[i].normal)));
      second = std::min(second, std::max(cost, best));
      if (cost < best) {
        best = cost;
        owner = i;
      }
    }
    if (best > 1e299) continue;
    const float area = std::max(side.area, side.emissionArea);
    areas[owner] += area;
    if (second - best < 1e-5 * (1 + best)) *doubtful += area;
  }
  return areas;
}

// The voxel side on which an eye path ends, after one bounce from point i mod points.
inline uint32_t endOfPath(const Room& room, const std::vector<Seen>& points, uint32_t path) {
  const uint32_t point = path % uint32_t(points.size()), turn = path / uint32_t(points.size());
  const Seen& from = points[point];
  if (!from.there) return scene::kNoSide;
  const uint32_t stream = randomStream(0, 0, 0x70617468u, point);
  const float r = std::sqrt(uniformFloat(hashCombine(stream, 0) + turn * 3242174889u)),
              phi = glm::two_pi<float>() * uniformFloat(hashCombine(stream, 1) + turn * 2447445414u);
  const glm::vec3 local(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r));
  const glm::vec3 direction = scene::toWorld(scene::orthonormalFrame(from.normal), local);
  return scene::traceVoxels(room.view(), from.position, direction, from.normal).side;
}

// Strategy `importance-area`: each of M eye paths, one bounce from point i mod points, is assigned to the nearest VPL
// of its kind (with `seenFirst`, of those that the point sees), found by trying every VPL. A VPL that the region
// hardly sees, with p below the least density or from less than 4 points, keeps a correspondingly small part of it
// (in 1024ths), and the nearest of all others gets the rest. `light` is the mean direct light of the paths in units
// of the VPL's own. gain is p by the disc of a cell over p by that of the VPL's own area. doubtful counts paths that
// two VPLs are equally near to, passed those that were passed on.
struct SharedAreas {
  std::vector<double> area, light, gain;
  int doubtful = 0;
  double passed = 0;
};

// The nearest VPL of those of the highest rank that count; as many as there are: none.
struct Nearest {
  size_t vpl;
  int rank = 0;
  double cost = 1e300, second = 1e300;
  void offer(size_t i, int otherRank, double other) {
    if (otherRank < rank) return;
    if (otherRank > rank) cost = second = 1e300;
    rank = otherRank;
    second = std::min(second, std::max(other, cost));
    if (other < cost) vpl = i;
    cost = std::min(cost, other);
  }
  bool doubtful() const { return second - cost < 1e-5 * (1 + cost); }
};

inline SharedAreas sharedAreas(const Room& room, const std::vector<scene::VplState>& vpls,
                               const std::vector<glm::vec4>& radiance, const std::vector<Seen>& points,
                               const Maps& maps, uint32_t paths, const WeightSettings& settings,
                               bool seenFirst = false) {
  SharedAreas result;
  std::vector<double> count(vpls.size(), 0.0), light(vpls.size(), 0.0), seenFrom;
  const auto p = seenDensities(room, vpls, points, maps, float(settings.clamp), nullptr, &seenFrom);
  const double lambda = normalLambda(room, settings.normalWeight), least = leastDensity(p, settings.areaCap);
  const auto part = [&](size_t i) { return std::min({p[i] / least, seenFrom[i] / 4, 1.0}); };
  const auto give = [&](size_t vpl, uint32_t side, double share) {
    count[vpl] += share;
    const double own = radiance[vpls[vpl].side].w;
    light[vpl] += share * (own > 0 ? std::min(radiance[side].w / own, 16.0) : 1);
  };
  std::vector<bool> sees;  // VPL after VPL of each point
  for (const Seen& s : points)
    for (size_t i = 0; i < vpls.size(); ++i)
      sees.push_back(seenTerm(s, vpls[i], maps, i, 1, float(settings.clamp)) > 0);
  uint32_t found = 0;
  for (uint32_t path = 0; path < paths; ++path) {
    const uint32_t point = path % uint32_t(points.size());
    const uint32_t s = endOfPath(room, points, path);
    if (s == scene::kNoSide) continue;
    ++found;
    const scene::VoxelSide& side = room.voxels.surface[s];
    Nearest owner{vpls.size()}, whole{vpls.size()};
    for (size_t i = 0; i < vpls.size(); ++i) {
      if (!(p[i] > 0)) continue;
      const glm::dvec3 d = glm::dvec3(vpls[i].position) - glm::dvec3(side.position);
      const bool same = (radiance[vpls[i].side].w > 0) == (radiance[s].w > 0);
      const double cost =
          glm::dot(d, d) + lambda * (1 - glm::dot(glm::dvec3(side.normal), glm::dvec3(vpls[i].normal)));
      const int rank = (seenFirst && sees[point * vpls.size() + i] ? 2 : 0) + (same ? 1 : 0);
      owner.offer(i, rank, cost);
      if (part(i) >= 1) whole.offer(i, rank, cost);
    }
    if (owner.vpl == vpls.size()) continue;
    const bool alone = owner.vpl == whole.vpl || whole.vpl == vpls.size();
    const double kept = alone ? 1 : std::floor(part(owner.vpl) * 1024 + 0.5) / 1024;
    result.doubtful += owner.doubtful() || (!alone && whole.doubtful());
    result.passed += 1 - kept;
    give(owner.vpl, s, kept);
    if (kept < 1) give(whole.vpl, s, 1 - kept);
  }
  result.area = pdfAreas(vpls, p, settings.areaCap, double(paths) / std::max(found, 1u));
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (p[i] > 0) result.area[i] = count[i] / (paths * p[i]);
    result.light.push_back(count[i] > 0 ? light[i] / count[i] : 1);
  }
  const auto own = seenDensities(room, vpls, points, maps, float(settings.clamp), &result.area);
  for (size_t i = 0; i < vpls.size(); ++i)
    result.gain.push_back(p[i] > 0 && own[i] > 0 && result.area[i] > 0 && !(settings.clamp > 0)
                              ? std::min(p[i] / own[i], settings.areaCap)
                              : 1);
  return result;
}

}  // namespace fovea::test
