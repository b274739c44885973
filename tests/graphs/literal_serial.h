// The paper's Algorithms 1 and 2 as a plain serial program that follows the frames of a graph and counts where they
// differ. Every step begins with what the graph's own pass before it has made, so that rounding does not add up.
#pragma once

#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <map>
#include <string>
#include <vector>

#include "passes/regions.h"
#include "tests/graphs/literal_frames.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/importance_reference.h"
#include "tests/passes/manage_reference.h"
#include "tests/passes/refresh_reference.h"
#include "tests/passes/weight_map_reference.h"

namespace fovea::test {

// What the text leaves open (passes/paper.md). The values are those of `ours_literal`.
struct LiteralChoices {
  uint32_t region = scene::kRegionFovea;
  bool intersection = true;  // whether a candidate lies where its ray meets a surface
  bool fromCentre = true;    // whether weights fall off from the gaze on
  double luminanceFloor = 1;
  uint32_t maxDensity = 1;
  std::string reuse = "linear";
  bool directLight = false;    // beside that of cones
  bool oneArea = true;         // for all VPLs
  bool top = true;             // whether maps of the most important VPLs are redrawn
  double clampDistance = 1.5;  // m, or in mean free paths
  bool clampInMeanFreePaths = false;
};

// How much of a step's results differs.
struct Tally {
  size_t compared = 0, off = 0;
  double allowed = 0;  // share of the results that rounding may change
  std::string first;   // of those that differ

  bool agrees() const { return double(off) <= allowed * double(compared); }
  void count(bool same, const std::string& what) {
    ++compared;
    if (!same && off++ == 0) first = what;
  }
};

class SerialProgram {
 public:
  SerialProgram(const scene::Scene& scene, const LiteralChoices& choices)
      : choices_(choices), scene_(scene), geometry_(scene::flatten(scene)), space_(scene, 8) {
    // Rounding sends some rays to another voxel and decides some comparisons with texels of maps and borders of
    // cells. What is decided with integers, or is copied, is equal.
    tallies_ = {{"voxels", {.allowed = 0.01}},
                {"candidates", {.allowed = 0.01}},
                {"rays of candidates", {.allowed = 0.03}},
                {"weights", {.allowed = 0.01}},
                {"motion", {}},
                {"importance", {.allowed = 0.01}},
                {"management", {}},
                {"radiosity", {.allowed = 0.04}},
                {"origins", {}},
                {"maps", {}},
                {"area", {}},
                {"picture", {.allowed = 0.05}}};
  }

  // Algorithm 1, the body of its loop.
  void frame(const LiteralFrame& f) {
    number_ = std::to_string(f.moment.index);
    voxelize(f);
    findCandidates(f);
    weigh(f);
    move(f);
    rate(f);
    manage(f);
    gather(f);
    place(f);
    drawMaps(f);
    giveAreas(f);
    shade(f);
    previousList_ = f.list;
    previousAtlas_ = f.atlas;
  }

  const std::map<std::string, Tally>& tallies() const { return tallies_; }

 private:
  template <class I>
  void count(const char* step, bool same, const char* what, I i) {
    tallies_.at(step).count(same, same ? "" : "frame " + number_ + ", " + what + " " + std::to_string(i));
  }

  // V <- Vs overlaid with the voxels of dynamic objects.
  void voxelize(const LiteralFrame& f) {
    scene::moveObjects(f.moment, geometry_);
    const VoxelArrays want = voxelizeReference(scene_, geometry_, kLiteralVoxels);
    for (size_t cell = 0; cell < want.index.size(); ++cell) {
      const uint32_t a = f.voxels.index[cell], b = want.index[cell];
      if (a == 0 && b == 0) continue;
      bool same = a != 0 && b != 0;
      for (uint32_t side = 0; side < 2 && same; ++side)
        same = sameSide(f.voxels.surface[2 * a - 2 + side], want.surface[2 * b - 2 + side]);
      count("voxels", same, "cell", cell);
    }
  }
  bool sameSide(const scene::VoxelSide& a, const scene::VoxelSide& b) const {
    if ((a.area > 0) != (b.area > 0)) return false;
    return b.area <= 0 ||
           (std::abs(a.area - b.area) <= 1e-3f * b.area + 1e-6f && a.object == b.object &&
            glm::distance(a.position, b.position) < 1e-3f && glm::distance(a.normal, b.normal) < 1e-3f &&
            glm::distance(a.reflectance, b.reflectance) < 1e-3f);
  }

  // Lc: one random ray from the surface at a random pixel of the region, for each attempt.
  void findCandidates(const LiteralFrame& f) {
    for (uint32_t i = 0; i < f.candidates.size(); ++i) {
      const CandidateReference reference{.image = f.seen,
                                         .voxels = f.voxels,
                                         .fovea = foveaOf(f, f.view().foveaRadius),
                                         .region = regionOfAttempt(i),
                                         .seed = f.moment.seed,
                                         .frame = uint32_t(f.moment.index)};
      const scene::Candidate& c = f.candidates[i];
      const CandidateReference::Attempt attempt = reference.attempt(i);
      bool same = c.side == attempt.side;
      if (!attempt.background) count("rays of candidates", same, "attempt", i);
      if (!same)
        same = !attempt.background && reference.mayMeet(i, c.side);
      else if (c.side != scene::kNoSide)
        same = sameCandidate(f, c, attempt);
      count("candidates", same, "attempt", i);
    }
  }
  // In a mixture, whole-image attempts are evenly interspersed.
  uint32_t regionOfAttempt(uint32_t i) const {
    if (choices_.region != scene::kRegionMixed) return choices_.region;
    const uint32_t share = passes::imageShare64ths(0.4);
    return (i + 1) * share >> 6 != i * share >> 6 ? scene::kRegionImage : scene::kRegionFovea;
  }
  bool sameCandidate(const LiteralFrame& f, const scene::Candidate& c,
                     const CandidateReference::Attempt& attempt) const {
    const scene::VoxelSide& side = f.voxels.surface[c.side];
    const glm::vec3 met = attempt.origin + attempt.distance * attempt.direction,
                    place = choices_.intersection ? met : side.position;
    // A ray that runs almost along the plane meets it less precisely.
    const float facing = std::max(std::abs(glm::dot(side.normal, attempt.direction)), 0.02f);
    return glm::distance(c.position, place) < 1e-4f / facing && c.normal == side.normal &&
           c.reflectance == side.reflectance && c.object == side.object &&
           glm::distance(c.localPosition, f.moment.objects[size_t(c.object)].intoObject(c.position)) < 1e-4f;
  }
  static scene::Fovea foveaOf(const LiteralFrame& f, float radius) {
    return scene::makeFovea(f.view().gaze, f.seen.size, radius);
  }

  // Foveated importance, first step: the weight of every side that the eye sees.
  void weigh(const LiteralFrame& f) {
    const glm::ivec2 size = f.seen.size;
    WeighedPicture picture(size.x, size.y, f.seen.camera);
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
      const SeenPixel& p = f.seen.pixels[i];
      picture.pixels[i] = {p.position, p.distance, p.face};
    }
    const float radius = choices_.fromCentre ? 1 / float(size.x) : f.view().foveaRadius;
    const SideWeights want = weightsReference(picture, f.voxels, f.view().eye, f.view().gaze, radius);
    for (size_t side = 0; side < want.weights.size(); ++side)
      if (want.weights[side] > 0 || f.weights[side] > 0)
        count("weights", std::abs(f.weights[side] - want.weights[side]) < 1e-5f, "side", side);
  }

  // L(i-1) in this frame: VPLs move with their objects and take their surface from its voxels, or end.
  void move(const LiteralFrame& f) {
    std::vector<scene::VplState> before = previousList_;
    before.resize(f.moved.size());
    for (size_t slot = 0; slot < before.size(); ++slot) {
      const scene::VplState& old = before[slot];
      scene::VplState want;
      if (old.life > 0) {
        const scene::ObjectTransform& object = f.moment.objects[size_t(old.object)];
        if (!followSurface(f, object, old, want)) continue;
      }
      const scene::VplState& got = f.moved[slot];
      const bool same = got.life == want.life && got.side == want.side && got.normal == want.normal &&
                        got.reflectance == want.reflectance && got.object == want.object &&
                        got.importance == want.importance &&
                        got.previousImportance == want.previousImportance &&
                        got.localPosition == want.localPosition && got.localNormal == want.localNormal &&
                        glm::distance(got.position, want.position) < 1e-4f;
      count("motion", same, "slot", slot);
    }
  }
  // Returns false where rounding decides, at the border of a cell or of the greatest turn.
  static bool followSurface(const LiteralFrame& f, const scene::ObjectTransform& object,
                            const scene::VplState& old, scene::VplState& now) {
    const bool moves = old.object > 0;
    const glm::vec3 position = moves ? object.fromObject(old.localPosition) : old.localPosition,
                    normal = moves ? object.normalFromObject(old.localNormal) : old.localNormal,
                    at = f.voxels.grid.worldToVoxel(position), border = glm::abs(at - glm::round(at));
    if (std::min({border.x, border.y, border.z}) < 1e-3f) return false;
    const glm::ivec3 cell(glm::floor(at));
    const bool inside = cell == glm::clamp(cell, glm::ivec3(0), glm::ivec3(kLiteralVoxels - 1));
    const uint32_t voxel = inside ? f.voxels.voxelAt(cell) : 0;
    float best = std::cos(glm::radians(30.0f));
    for (uint32_t s = 2 * voxel - 2; voxel > 0 && s < 2 * voxel; ++s) {
      const scene::VoxelSide& side = f.voxels.surface[s];
      const float cosine = glm::dot(side.normal, normal);
      if (side.area <= 0 || side.object != old.object) continue;
      if (std::abs(cosine - best) < 1e-4f) return false;
      if (cosine < best) continue;
      best = cosine;
      now = old;
      now.position = position;
      now.normal = side.normal;
      now.reflectance = side.reflectance;
      now.side = s;
      now.life = old.life + 1;
      now.previousImportance = old.importance;
    }
    return true;
  }

  // Foveated importance, second step: six rays from each candidate and VPL.
  void rate(const LiteralFrame& f) {
    ImportanceReference reference{{f.voxels.grid, f.voxels.index, f.voxels.surface}, f.weights};
    const auto compare = [&](float got, const auto& x, bool live, size_t i) {
      if (!live) return count("importance", got == 0, "empty entry", i);
      const double bright = std::min(1.0, double(f.moment.exposure) * double(f.voxelRadiance[x.side].w));
      const double light = choices_.luminanceFloor + (1 - choices_.luminanceFloor) * bright;
      const ImportanceReference::Range range = reference.importance(x.position, x.normal);
      count("importance", got >= light * range.low - 1e-5 && got <= light * range.high + 1e-5, "entry", i);
    };
    for (size_t i = 0; i < f.candidates.size(); ++i)
      compare(f.candidateImportance[i], f.candidates[i], f.candidates[i].side != scene::kNoSide, i);
    for (size_t i = 0; i < f.moved.size(); ++i)
      compare(f.vplImportance[i], f.moved[i], f.moved[i].life > 0, i);
  }

  // Li: Eq. 1 and Algorithm 2, bit for bit.
  void manage(const LiteralFrame& f) {
    const ManageSettings settings{
        .reuse = choices_.reuse, .maxDensity = choices_.maxDensity, .cell = kLiteralCell};
    ManageInput in;
    in.candidates = f.candidates;
    in.candidateImportance = f.candidateImportance;
    in.vpls = f.moved;
    in.vplImportance = f.vplImportance;
    in.seed = f.moment.seed;
    in.frame = uint32_t(f.moment.index);
    in.boundsMin = geometry_.boundsMin;
    in.boundsMax = geometry_.boundsMax;
    ManageOutput want = ManageReference(settings, in).run();
    for (size_t slot = 0; slot < want.vpls.size(); ++slot) {
      scene::VplState& vpl = want.vpls[slot];
      const scene::VplState& got = f.list.at(slot);
      // The reference knows no objects, in whose space the normal of a new VPL is kept.
      if (vpl.life == 1 && vpl.object > 0) {
        const glm::vec3 local = f.moment.objects[size_t(vpl.object)].normalIntoObject(vpl.normal);
        if (glm::distance(local, got.localNormal) < 1e-5f) vpl.localNormal = got.localNormal;
      }
      count("management", std::memcmp(&got, &vpl, sizeof(vpl)) == 0, "slot", slot);
    }
    count("management", f.counter("manage.kept") == want.kept, "kept:", want.kept);
    count("management", f.counter("manage.deleted") == want.deleted, "deleted:", want.deleted);
    count("management", f.counter("manage.added") == want.added, "added:", want.added);
    count("management", f.counter("manage.rejected") == want.rejected, "rejected:", want.rejected);
    count("management", f.counter("manage.dense") == want.dense, "refused:", want.dense);
  }

  // Eq. 3: the light that six cones bring to each VPL.
  void gather(const LiteralFrame& f) {
    space_.voxels = f.voxels;
    for (uint32_t slot = 0; slot < f.list.size(); ++slot) {
      const scene::VplState& v = f.list[slot];
      glm::vec3 want(0);
      if (v.life > 0) {
        const float turn = glm::two_pi<float>() * uniformFloat(randomStream(f.moment.seed, 0, 0x4ad, slot));
        want = v.reflectance * referenceGather(space_, f.mips, f.voxelRadiance, v.position, v.normal, turn);
        if (choices_.directLight) want += glm::pi<float>() * glm::vec3(f.voxelRadiance[v.side]);
      }
      const float difference = glm::distance(glm::vec3(f.radiosity[slot]), want);
      count("radiosity", difference <= 5e-3f * glm::length(want) + 1e-6f, "slot", slot);
    }
  }

  // Where VPLs emit from: slightly above their surface.
  void place(const LiteralFrame& f) {
    for (size_t slot = 0; slot < f.list.size(); ++slot) {
      const scene::VplState& v = f.list[slot];
      const bool alive = v.life > 0;
      const glm::vec3 origin = alive ? v.position + 0.15f * f.voxels.grid.cell * v.normal : glm::vec3(0),
                      light = alive ? glm::vec3(f.radiosity[slot]) / glm::pi<float>() : glm::vec3(0);
      const scene::Vpl& got = f.placed[slot];
      count("origins",
            glm::distance(got.position, origin) < 1e-5f && got.normal == v.normal &&
                glm::distance(got.intensity, light) <= 1e-5f * glm::length(light),
            "slot", slot);
    }
  }

  // Maps: of all new VPLs, and of the most important of the others. A map that is not drawn keeps its bits.
  void drawMaps(const LiteralFrame& f) {
    const std::vector<uint32_t> before = refresh_.drawnIn;
    const std::vector<bool> draw =
        refresh_.frame(f.placed, f.list, uint32_t(f.moment.index), kLiteralRefreshShare, "top");
    const size_t texels = kLiteralMap * kLiteralMap;
    double fresh = 0, drawn = 0;
    for (size_t slot = 0; slot < draw.size(); ++slot) {
      const bool isNew = draw[slot] && (before.empty() || before[slot] == 0 || f.list[slot].life <= 1);
      fresh += isNew;
      drawn += draw[slot];
      if (previousAtlas_.empty() || draw[slot] || refresh_.drawnIn[slot] == 0) continue;
      const auto first = std::ptrdiff_t(slot * texels), last = std::ptrdiff_t((slot + 1) * texels);
      const bool kept =
          std::equal(f.atlas.begin() + first, f.atlas.begin() + last, previousAtlas_.begin() + first);
      if (choices_.top) count("maps", kept, "map", slot);
    }
    const double maps = f.counter("shadow-atlas.maps");
    count("maps", f.counter("shadow-atlas.new_maps") == fresh, "new:", fresh);
    // Another choice has the same number of maps to spend, but may find fewer that would change.
    count("maps", choices_.top ? maps + f.counter("shadow-atlas.unchanged_maps") == drawn : maps <= drawn,
          "drawn:", drawn);
  }

  // Eq. 2 has one area for all VPLs, whose total is set in the first frame with light.
  void giveAreas(const LiteralFrame& f) {
    if (!choices_.oneArea) return;
    const double alive = f.counter("manage.alive");
    for (size_t slot = 0; slot < f.list.size(); ++slot) {
      if (f.list[slot].life == 0) continue;
      const scene::Vpl& got = f.emitters[slot];
      if (area_ == 0) area_ = double(got.area) * alive;
      const glm::vec3 light = glm::vec3(f.radiosity[slot]) * (float(area_ / alive) / glm::pi<float>());
      count("area",
            area_ > 0 && std::abs(double(got.area) * alive - area_) <= 1e-5 * area_ &&
                glm::distance(got.intensity, light) <= 1e-4f * glm::length(light),
            "slot", slot);
    }
  }

  // Eq. 2, with the clamp. The reference has one normal for light and shadow, so flat surfaces are compared.
  void shade(const LiteralFrame& f) {
    const GBuffer pixels(f.seen.size.x, f.seen.size.y, [&](int x, int y) {
      const SeenPixel& p = f.seen.at({x, y});
      return SurfacePixel{.position = p.position, .distance = p.distance, .normal = p.normal};
    });
    DeferredReference reference;
    reference.clampDistance =
        choices_.clampDistance * (choices_.clampInMeanFreePaths ? double(geometry_.meanFreePath) : 1);
    reference.atlas = &f.atlas;
    reference.size = kLiteralMap;
    const std::vector<glm::dvec3> want = reference.irradiance(pixels, f.emitters);
    double mean = 0;
    for (const glm::dvec3& e : want) mean += glm::length(e) / double(want.size());
    for (size_t i = 0; i < want.size(); ++i) {
      const SeenPixel& p = f.seen.pixels[i];
      if (p.distance <= 0 || glm::dot(glm::normalize(p.normal), p.face) < 0.9999f) continue;
      const glm::dvec3 got(f.irradiance[4 * i], f.irradiance[4 * i + 1], f.irradiance[4 * i + 2]);
      count("picture", glm::distance(got, want[i]) <= 0.01 * glm::length(want[i]) + 2e-3 * mean, "pixel", i);
    }
  }

  LiteralChoices choices_;
  const scene::Scene& scene_;
  scene::Geometry geometry_;
  VoxelScene space_;  // with the voxels of the frame
  std::string number_;
  std::map<std::string, Tally> tallies_;
  std::vector<scene::VplState> previousList_;
  std::vector<uint32_t> previousAtlas_;
  RefreshReference refresh_;
  double area_ = 0;  // of all VPLs together, m^2
};

}  // namespace fovea::test
