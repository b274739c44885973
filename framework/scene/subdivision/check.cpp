// Checks a cage before it is passed to OpenSubdiv, which treats invalid topology as a programming error.
#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace {

constexpr size_t kMaxProblems = 8;

std::string at(const char* list, size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; }

class CageChecker {
 public:
  explicit CageChecker(const SubdivisionCage& cage) : cage_(cage) {}

  // Each step relies on the ones before it.
  std::vector<CageProblem> run() {
    values();
    if (problems_.empty()) faces();
    if (problems_.empty()) neighbours();
    if (problems_.empty()) sharpness();
    if (problems_.empty()) limits();
    return std::move(problems_);
  }

 private:
  void problem(std::string place, std::string message, std::string remedy = {}) {
    if (problems_.size() < kMaxProblems)
      problems_.push_back({std::move(place), std::move(message), std::move(remedy)});
  }

  void values() {
    if (cage_.level < 1 || cage_.level > SubdivisionCage::kMaxLevel)
      problem("level", "the level of refinement is " + std::to_string(cage_.level) + ", not in 1 to " +
                           std::to_string(SubdivisionCage::kMaxLevel));
    if (cage_.lightLevel && *cage_.lightLevel > cage_.level)
      problem("lightLevel",
              "the level for voxels and maps of secondary lights is " + std::to_string(*cage_.lightLevel) +
                  ", finer than that of the picture, " + std::to_string(cage_.level),
              "leave it out, or choose one from 0 to " + std::to_string(cage_.level));
    for (size_t i = 0; i < cage_.positions.size(); ++i)
      if (const glm::vec3& p = cage_.positions[i];
          !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        problem(at("positions", i), "is not finite (NaN or infinity)");
    for (size_t i = 0; i < cage_.uvs.size(); ++i)
      if (!std::isfinite(cage_.uvs[i].x) || !std::isfinite(cage_.uvs[i].y))
        problem(at("uvs", i), "is not finite (NaN or infinity)");
    const size_t points = cage_.positions.size();
    for (size_t i = 0; i < cage_.targets.size(); ++i) {
      const std::vector<glm::vec3>& moved = cage_.targets[i].positions;
      if (!moved.empty() && moved.size() != points)
        problem(at("targets", i),
                std::to_string(moved.size()) + " displacements for " + std::to_string(points) + " points");
    }
    if (cage_.joints.size() != cage_.weights.size() ||
        (!cage_.joints.empty() && cage_.joints.size() != points))
      problem("joints", std::to_string(cage_.joints.size()) + " sets of joints and " +
                            std::to_string(cage_.weights.size()) + " of weights for " +
                            std::to_string(points) + " points");
  }

  void faces() {
    uint64_t corners = 0;
    for (size_t f = 0; f < cage_.faceSizes.size(); ++f) {
      const uint32_t size = cage_.faceSizes[f];
      if (size < 3 || size > SubdivisionCage::kMaxFaceSize)
        problem(at("faceSizes", f), "a face of " + std::to_string(size) + " vertices; it takes 3 to " +
                                        std::to_string(SubdivisionCage::kMaxFaceSize));
      else if (cage_.scheme == SubdivisionCage::Scheme::Loop && size != 3)
        problem(at("faceSizes", f),
                "a face of " + std::to_string(size) + " vertices; Loop subdivision takes triangles only",
                "use Catmull-Clark, or split the faces");
      corners += size;
    }
    if (cage_.faceSizes.empty()) problem("faceSizes", "the cage has no faces");
    if (corners != cage_.faceVertices.size())
      problem("faceVertices", "has " + std::to_string(cage_.faceVertices.size()) +
                                  " entries; the sizes of the faces add up to " + std::to_string(corners));
    if (!cage_.faceMaterials.empty() && cage_.faceMaterials.size() != cage_.faceSizes.size())
      problem("faceMaterials", std::to_string(cage_.faceMaterials.size()) + " materials for " +
                                   std::to_string(cage_.faceSizes.size()) + " faces");
    indices("faceVertices", cage_.faceVertices, cage_.positions.size());
    if (!cage_.faceUvs.empty() && cage_.faceUvs.size() != cage_.faceVertices.size())
      problem("faceUvs", "has " + std::to_string(cage_.faceUvs.size()) + " entries, faceVertices has " +
                             std::to_string(cage_.faceVertices.size()));
    if (cage_.faceUvs.empty() && !cage_.uvs.empty()) problem("faceUvs", "is missing, though there are uvs");
    indices("faceUvs", cage_.faceUvs, cage_.uvs.size());
    if (problems_.empty()) repeats();
  }

  void indices(const char* list, const std::vector<uint32_t>& values, size_t count) {
    for (size_t i = 0; i < values.size(); ++i)
      if (values[i] >= count)
        problem(at(list, i),
                "index " + std::to_string(values[i]) + ", but there are only " + std::to_string(count));
  }

  void repeats() {
    size_t first = 0;
    for (size_t f = 0; f < cage_.faceSizes.size(); first += cage_.faceSizes[f++]) {
      const auto begin = cage_.faceVertices.begin() + long(first);
      std::vector<uint32_t> sorted(begin, begin + cage_.faceSizes[f]);
      std::sort(sorted.begin(), sorted.end());
      if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
        problem(at("faces", f), "names vertex " + std::to_string(*twice) + " twice");
    }
  }

  // A corner of a face at vertex v, with the vertices before and after it.
  struct Corner {
    uint32_t vertex, next, previous, face;
    bool operator<(const Corner& o) const {
      return vertex != o.vertex ? vertex < o.vertex : next != o.next ? next < o.next : face < o.face;
    }
  };

  void neighbours() {
    corners_.reserve(cage_.faceVertices.size());
    size_t first = 0;
    for (uint32_t f = 0; f < cage_.faceSizes.size(); first += cage_.faceSizes[f++]) {
      const uint32_t size = cage_.faceSizes[f];
      const uint32_t* v = &cage_.faceVertices[first];
      for (uint32_t k = 0; k < size; ++k)
        corners_.push_back({v[k], v[(k + 1) % size], v[(k + size - 1) % size], f});
    }
    std::sort(corners_.begin(), corners_.end());
    for (size_t i = 0; i + 1 < corners_.size(); ++i) {
      const Corner &a = corners_[i], &b = corners_[i + 1];
      if (a.vertex == b.vertex && a.next == b.next)
        problem(at("faces", b.face),
                "runs along the edge from vertex " + std::to_string(a.vertex) + " to " +
                    std::to_string(a.next) + " in the same direction as face " + std::to_string(a.face),
                "an edge has at most two faces, which run along it in opposite directions: turn one of them "
                "round, or give it vertices of its own");
    }
    if (problems_.empty()) fans();
  }

  // The corner of a face at the directed edge from `vertex` to `next`; null if there is none.
  const Corner* find(uint32_t vertex, uint32_t next) const {
    const auto found = std::lower_bound(corners_.begin(), corners_.end(), Corner{vertex, next, 0, 0});
    return found != corners_.end() && found->vertex == vertex && found->next == next ? &*found : nullptr;
  }

  // The faces around a vertex, one after the other across shared edges, must be all of its faces.
  void fans() {
    size_t begin = 0;
    for (uint32_t v = 0; v < cage_.positions.size(); ++v) {
      size_t end = begin;
      while (end < corners_.size() && corners_[end].vertex == v) ++end;
      const size_t count = end - begin;
      if (count == 0) {
        problem(at("positions", v), "belongs to no face", "leave it out");
        continue;
      }
      if (count > SubdivisionCage::kMaxValence)
        problem(at("positions", v), std::to_string(count) + " faces meet here; at most " +
                                        std::to_string(SubdivisionCage::kMaxValence) + " may");
      // From the face on the boundary, if there is one.
      const Corner* start = &corners_[begin];
      for (size_t i = begin; i < end; ++i)
        if (!find(corners_[i].next, v)) start = &corners_[i];
      size_t seen = 0;
      const Corner* c = start;
      do {
        ++seen;
        c = find(v, c->previous);
      } while (c && c != start && seen <= count);
      if (seen != count)
        problem(at("positions", v), "faces that share no edge meet only in this vertex",
                "give each group of faces a vertex of its own");
      begin = end;
    }
  }

  void sharpness() {
    const auto sharp = [](float s) { return std::isfinite(s) && s >= 0; };
    for (size_t i = 0; i < cage_.creases.size(); ++i) {
      const SubdivisionCage::Crease& c = cage_.creases[i];
      if (!sharp(c.sharpness)) problem(at("creases", i), "its sharpness is negative or not finite");
      if (c.a >= cage_.positions.size() || c.b >= cage_.positions.size() ||
          (!find(c.a, c.b) && !find(c.b, c.a)))
        problem(at("creases", i),
                "there is no edge between vertices " + std::to_string(c.a) + " and " + std::to_string(c.b));
    }
    for (size_t i = 0; i < cage_.corners.size(); ++i) {
      const SubdivisionCage::Corner& c = cage_.corners[i];
      if (!sharp(c.sharpness)) problem(at("corners", i), "its sharpness is negative or not finite");
      if (c.vertex >= cage_.positions.size())
        problem(at("corners", i), "there is no vertex " + std::to_string(c.vertex));
    }
  }

  void limits() {
    if (const uint64_t count = refinedTriangles(cage_); count > SubdivisionCage::kMaxTriangles)
      problem("level",
              "level " + std::to_string(cage_.level) + " makes " + std::to_string(count) +
                  " triangles of this cage; at most " + std::to_string(SubdivisionCage::kMaxTriangles) +
                  " can be used",
              "lower the level");
  }

  const SubdivisionCage& cage_;
  std::vector<Corner> corners_;
  std::vector<CageProblem> problems_;
};

}  // namespace

std::vector<CageProblem> checkCage(const SubdivisionCage& cage) { return CageChecker(cage).run(); }

uint64_t refinedTriangles(const SubdivisionCage& cage) {
  if (cage.scheme == SubdivisionCage::Scheme::Loop)
    return uint64_t(cage.faceSizes.size()) << (2 * cage.level);
  return cage.level == 0 ? 0 : uint64_t(cage.faceVertices.size()) * 2 << (2 * (cage.level - 1));
}

}  // namespace fovea::scene
