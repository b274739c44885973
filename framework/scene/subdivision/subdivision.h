// Subdivision surfaces (OpenSubdiv): control cages are uniformly refined to triangles on the limit surface, and
// stencil tables give the same points for cages that deform.
//
// Boundary edges are sharp: the surface follows the boundary's own curve. A boundary vertex of a single face is a
// corner and stays in place. A crease of sharpness s acts as a boundary for floor(s) levels and fades out with the
// fraction (DeRose, Kass, Truong 1998, section 5); a sharpness of 10 or more never fades. Along edges that are still
// sharp at the last level the surface is split: each side has vertices with the normal of that side. A level above s
// is needed to see the rounding of a crease of sharpness s.
//
// Texture coordinates are face-varying and smooth where they are continuous ("corners plus 1" of OpenSubdiv).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

// A control mesh in the space of its mesh, with its original faces (quads are kept). Every edge has at most two
// faces, every vertex has one fan of faces, and neighbouring faces have the same orientation.
struct SubdivisionCage {
  enum class Scheme : uint8_t { CatmullClark, Loop };  // Loop: triangles only
  struct Crease {
    uint32_t a, b;  // an edge of the cage
    float sharpness;
  };
  struct Corner {
    uint32_t vertex;
    float sharpness;
  };

  Scheme scheme = Scheme::CatmullClark;
  std::vector<glm::vec3> positions;               // each is used by a face
  std::vector<uint32_t> faceSizes, faceVertices;  // counter-clockwise; sizes 3..kMaxFaceSize
  std::vector<glm::vec2> uvs;                     // all zero if empty
  std::vector<uint32_t> faceUvs;                  // indices into uvs, one for each of faceVertices
  std::vector<Crease> creases;                    // a sharpness >= 10 is infinite
  std::vector<Corner> corners;
  std::vector<uint32_t> faceMaterials;  // per face; material 0 if empty
  uint32_t level = 2;                   // levels of uniform refinement, 1..kMaxLevel
  // Level that voxels and maps of secondary lights see, 0..level: triangles between the limit points of its vertices.
  // If absent, `level`.
  std::optional<uint32_t> lightLevel;

  // Data of a cage that deforms, as in a Primitive, with one entry per cage point (normals are not used).
  std::vector<MorphTarget> targets;
  std::vector<glm::u16vec4> joints;
  std::vector<glm::vec4> weights;

  static constexpr uint32_t kMaxLevel = 8, kMaxFaceSize = 64, kMaxValence = 1024;
  static constexpr uint64_t kMaxTriangles = uint64_t(1) << 22;  // after refinement
};

// A problem of a cage; `place` is within it, such as "creases[3]".
struct CageProblem {
  std::string place, message, remedy;
};
// The first few problems; empty if the cage can be refined.
std::vector<CageProblem> checkCage(const SubdivisionCage& cage);

// Number of triangles that refine() would make, without refining: (corners of all faces) * 4^(level-1) * 2, or faces
// * 4^level for Loop.
uint64_t refinedTriangles(const SubdivisionCage& cage);

// Triangles at cage.level: one primitive per material (ascending), with limit positions and unit limit normals, and
// with Primitive::lightIndices where cage.lightLevel is below it. The order of the result is deterministic: it
// depends on the cage's connectivity and materials alone. Throws Error(BadInput) for an invalid cage, and always if
// fovea was built without OpenSubdiv.
std::vector<Primitive> refine(const SubdivisionCage& cage);

// Makes the primitives of each mesh that has a cage and no primitives yet. Loaders and generators call it last,
// because the code that draws does not know of cages. Throws as refine() does, naming the mesh.
void refineCages(Scene& scene);

// The vertices of refine() (all primitives, one after the other) as weighted sums of cage points: the limit position
// p and two limit tangents a, b with normal = normalize(a x b).
class Stencils {
 public:
  struct Range {
    uint32_t first, count;  // entries
  };
  struct Entry {
    float position, tangentA, tangentB;  // weights
    uint32_t point;                      // index of a cage point
  };

  // Throws as refine() does.
  explicit Stencils(const SubdivisionCage& cage);

  uint32_t pointCount() const { return points_; }                    // of the cage
  uint32_t vertexCount() const { return uint32_t(ranges_.size()); }  // refined
  // Flat arrays for texel buffers (rg32ui, and rgba32f with the point's index as bits); vertices at a
  // seam share entries.
  const std::vector<Range>& ranges() const { return ranges_; }
  const std::vector<Entry>& entries() const { return entries_; }

  // points: pointCount() entries; positions, normals: vertexCount() entries. A normal that vanishes becomes
  // (0, 1, 0).
  void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> positions,
                std::span<glm::vec3> normals) const;

 private:
  uint32_t points_ = 0;
  std::vector<Range> ranges_;
  std::vector<Entry> entries_;
};

}  // namespace fovea::scene
