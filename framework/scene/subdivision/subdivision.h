// Subdivision surfaces (OpenSubdiv): control cages, uniformly refined to triangles on the limit surface, and
// stencil tables that give the same points for cages that deform.
//
// Creases and boundaries. A boundary edge is sharp (it follows the boundary's own curve); a boundary vertex
// of one face is a corner and stays where it is. A crease of sharpness s takes part in floor(s) levels as if
// it were a boundary and fades out with the fraction (DeRose, Kass, Truong 1998, section 5); >= 10 never
// fades. Along edges that are still sharp at the last level the surface is split: each side has vertices with
// the normal of that side. Whoever wants to see the rounding of a crease of sharpness s needs a level above
// s.
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

// A control mesh in the space of its mesh, faces as they are (quads kept). Every edge has at most two faces,
// every vertex one fan of faces, neighbouring faces run the same way round.
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
  std::vector<glm::vec3> positions;               // each used by a face
  std::vector<uint32_t> faceSizes, faceVertices;  // counter-clockwise; sizes 3..kMaxFaceSize
  std::vector<glm::vec2> uvs;                     // may be empty: all zero
  std::vector<uint32_t> faceUvs;                  // into uvs, one for each of faceVertices
  std::vector<Crease> creases;                    // sharpness >= 10: infinite
  std::vector<Corner> corners;
  std::vector<uint32_t> faceMaterials;  // a face; may be empty: material 0
  uint32_t level = 2;                   // of uniform refinement, 1..kMaxLevel
  // What voxels and VPL maps see: triangles between the limit points of the vertices of this level, 0..level.
  // None: `level`.
  std::optional<uint32_t> lightLevel;

  // Of a cage that deforms, as of a Primitive, one entry a cage point (normals are not used).
  std::vector<MorphTarget> targets;
  std::vector<glm::u16vec4> joints;
  std::vector<glm::vec4> weights;

  static constexpr uint32_t kMaxLevel = 8, kMaxFaceSize = 64, kMaxValence = 1024;
  static constexpr uint64_t kMaxTriangles = uint64_t(1) << 22;  // after refinement
};

// What is wrong with a cage; `place` is inside it: "creases[3]".
struct CageProblem {
  std::string place, message, remedy;
};
// The first few problems; empty for a cage that can be refined.
std::vector<CageProblem> checkCage(const SubdivisionCage& cage);

// Of refine(), without refining: (corners of all faces) * 4^(level-1) * 2, for Loop faces * 4^level.
uint64_t refinedTriangles(const SubdivisionCage& cage);

// Triangles at cage.level: one primitive a material (ascending), limit positions, unit limit normals; with
// Primitive::lightIndices where cage.lightLevel is below it.
// Deterministic: the order depends on the cage's connectivity and materials alone. Throws Error(BadInput) for
// a bad cage and where fovea was built without OpenSubdiv.
std::vector<Primitive> refine(const SubdivisionCage& cage);

// Makes the primitives of each mesh that has a cage and no primitives yet. Loaders and generators end with
// it: nothing that draws knows of cages. Throws as refine(), naming the mesh.
void refineCages(Scene& scene);

// The vertices of refine() (all primitives, one after the other) as weighted sums of cage points: limit
// position p and two limit tangents a, b with normal = normalize(a x b).
class Stencils {
 public:
  struct Range {
    uint32_t first, count;  // entries
  };
  struct Entry {
    float position, tangentA, tangentB;  // weights
    uint32_t point;                      // of the cage
  };

  // Throws as refine().
  explicit Stencils(const SubdivisionCage& cage);

  uint32_t pointCount() const { return points_; }                    // of the cage
  uint32_t vertexCount() const { return uint32_t(ranges_.size()); }  // refined
  // Flat, for texel buffers (rg32ui, rgba32f with the point's index as bits); vertices at a seam share
  // entries.
  const std::vector<Range>& ranges() const { return ranges_; }
  const std::vector<Entry>& entries() const { return entries_; }

  // points: pointCount(); positions, normals: vertexCount(). A normal that vanishes becomes (0, 1, 0).
  void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> positions,
                std::span<glm::vec3> normals) const;

 private:
  uint32_t points_ = 0;
  std::vector<Range> ranges_;
  std::vector<Entry> entries_;
};

}  // namespace fovea::scene
