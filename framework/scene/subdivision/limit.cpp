// The part of subdivision surfaces that uses OpenSubdiv: topology, refinement masks and limit masks. The tangents of
// the sides of sharp features are computed here, because OpenSubdiv gives only one side of a crease.
#include "framework/scene/subdivision/limit.h"

#include "fovea/error.h"

#ifdef FOVEA_OPENSUBDIV
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#endif

namespace fovea::scene {

void SparseRow::AddWithWeight(const SparseRow& row, float weight) {
  if (weight == 0.0f) return;
  std::vector<std::pair<uint32_t, float>> sum;
  sum.reserve(terms.size() + row.terms.size());
  auto a = terms.begin();
  auto b = row.terms.begin();
  while (a != terms.end() || b != row.terms.end()) {
    if (b == row.terms.end() || (a != terms.end() && a->first < b->first)) {
      sum.push_back(*a++);
    } else if (a == terms.end() || b->first < a->first) {
      sum.emplace_back(b->first, weight * b->second);
      ++b;
    } else {
      sum.emplace_back(a->first, a->second + weight * b->second);
      ++a, ++b;
    }
  }
  terms = std::move(sum);
}

#ifdef FOVEA_OPENSUBDIV

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using Far::ConstIndexArray;
using Far::TopologyLevel;

// Vectors with the member names that OpenSubdiv requires.
template <class Vector>
struct Sum {
  Vector v{0.0f};
  void Clear() { v = Vector(0.0f); }
  void AddWithWeight(const Sum& other, float weight) { v += weight * other.v; }
};

std::unique_ptr<Far::TopologyRefiner> makeRefiner(const SubdivisionCage& cage) {
  const std::vector<int> sizes(cage.faceSizes.begin(), cage.faceSizes.end());
  const std::vector<int> vertices(cage.faceVertices.begin(), cage.faceVertices.end());
  const std::vector<int> uvs(cage.faceUvs.begin(), cage.faceUvs.end());
  std::vector<int> creaseEnds, corners;
  std::vector<float> creaseWeights, cornerWeights;
  for (const SubdivisionCage::Crease& c : cage.creases) {
    creaseEnds.insert(creaseEnds.end(), {int(c.a), int(c.b)});
    creaseWeights.push_back(std::min(c.sharpness, Sdc::Crease::SHARPNESS_INFINITE));
  }
  for (const SubdivisionCage::Corner& c : cage.corners) {
    corners.push_back(int(c.vertex));
    cornerWeights.push_back(std::min(c.sharpness, Sdc::Crease::SHARPNESS_INFINITE));
  }
  Far::TopologyDescriptor::FVarChannel channel;
  channel.numValues = int(cage.uvs.size());
  channel.valueIndices = uvs.data();
  Far::TopologyDescriptor d;
  d.numVertices = int(cage.positions.size());
  d.numFaces = int(sizes.size());
  d.numVertsPerFace = sizes.data();
  d.vertIndicesPerFace = vertices.data();
  d.numCreases = int(cage.creases.size());
  d.creaseVertexIndexPairs = creaseEnds.data();
  d.creaseWeights = creaseWeights.data();
  d.numCorners = int(cage.corners.size());
  d.cornerVertexIndices = corners.data();
  d.cornerWeights = cornerWeights.data();
  d.numFVarChannels = uvs.empty() ? 0 : 1;
  d.fvarChannels = &channel;

  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
  const Sdc::SchemeType scheme =
      cage.scheme == SubdivisionCage::Scheme::Loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(d, Factory::Options(scheme, options)));
  if (!refiner)
    throw Error(ExitCode::Internal, "OpenSubdiv does not take a subdivision cage that was checked");
  Far::TopologyRefiner::UniformOptions uniform(int(cage.level));
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  return refiner;
}

// Limit tangents at a vertex seen from the faces between two of its sharp edges.
struct TangentMask {
  struct Term {
    int point;  // of the last level
    float a, b;
  };
  std::vector<Term> terms;
  void add(int point, double a, double b) { terms.push_back({point, float(a), float(b)}); }
};

// The faces of `vertex` from one sharp edge to the next, counter-clockwise: k faces and k + 1 edges. A closed ring,
// as at the tip of a cone, has k edges.
struct Sector {
  int vertex = 0;
  std::vector<int> edgePoints;      // the other ends of the edges
  std::vector<int> diagonalPoints;  // of quads: the corner across
  size_t faces = 0;
  bool crease = false;  // the curve through the vertex is smooth; else the vertex is a corner
  bool closed = false;
};

// The tip of a cone has no tangent plane; the lowest harmonics of its ring are used instead.
TangentMask ringMask(const Sector& s) {
  TangentMask mask;
  for (size_t i = 0; i < s.faces; ++i) {
    const double angle = 2.0 * std::numbers::pi * double(i) / double(s.faces);
    mask.add(s.edgePoints[i], std::cos(angle), std::sin(angle));
  }
  return mask;
}

// A single face between two sharp edges e, e': (e - v) x (e' - v), written as a difference and a sum. A quad whose
// two edges are collinear would lose its normal; a ten-thousandth of the diagonal preserves it.
TangentMask singleFaceMask(const Sector& s) {
  const double diagonal = s.diagonalPoints.empty() ? 0.0 : 1e-4;
  TangentMask mask;
  mask.add(s.edgePoints[0], 1, 1);
  mask.add(s.edgePoints[1], -1, 1);
  if (diagonal > 0) mask.add(s.diagonalPoints[0], 0, diagonal);
  mask.add(s.vertex, 0, -2 - diagonal);
  return mask;
}

// With more than one face at a corner there is in general no tangent plane, since the eigenvalue of the inner edges
// is at least that of the sharp ones. The difference of the sharp edges and the sum of the inner ones span the plane
// if the faces are flat, also where the corner is straight or concave.
TangentMask cornerMask(const Sector& s) {
  TangentMask mask;
  const size_t k = s.faces;
  mask.add(s.edgePoints[0], 1, 0);
  mask.add(s.edgePoints[k], -1, 0);
  for (size_t i = 1; i < k; ++i) mask.add(s.edgePoints[i], 0, 1);
  mask.add(s.vertex, 0, -double(k - 1));
  return mask;
}

// Tangent across a smooth crease or boundary: Biermann, Levin, Zorin 2000, "Piecewise smooth subdivision surfaces
// with normal control", appendix, with theta = pi / k; for two quads it is that of the uniform bicubic B-spline.
TangentMask quadCreaseMask(const Sector& s) {
  const size_t k = s.faces;
  const double theta = std::numbers::pi / double(k);
  const double cosine = std::cos(theta), sine = std::sin(theta);
  const double ratio = (1 + cosine) / sine;
  TangentMask mask;
  const double end = -ratio * (1 + 2 * cosine);
  mask.add(s.edgePoints[0], 1, end);
  mask.add(s.edgePoints[k], -1, end);
  for (size_t i = 1; i < k; ++i) mask.add(s.edgePoints[i], 0, 4 * std::sin(double(i) * theta));
  for (size_t i = 0; i < k; ++i)
    mask.add(s.diagonalPoints[i], 0, std::sin(double(i) * theta) + std::sin(double(i + 1) * theta));
  mask.add(s.vertex, 0, 4 * ratio * (cosine - 1));
  return mask;
}

// Loop: Hoppe et al. 1994, "Piecewise smooth surface reconstruction", section 3.
TangentMask triangleCreaseMask(const Sector& s) {
  const size_t k = s.faces;
  TangentMask mask;
  if (k <= 3) {
    const double inner = k == 2 ? 1 : 2, end = k == 2 ? 0 : -1;
    mask.add(s.edgePoints[0], 1, end);
    mask.add(s.edgePoints[k], -1, end);
    for (size_t i = 1; i < k; ++i) mask.add(s.edgePoints[i], 0, inner);
    mask.add(s.vertex, 0, k == 2 ? -1 : -2);
    return mask;
  }
  const double theta = std::numbers::pi / double(k);
  mask.add(s.edgePoints[0], 1, -std::sin(theta));
  mask.add(s.edgePoints[k], -1, -std::sin(theta));
  for (size_t i = 1; i < k; ++i)
    mask.add(s.edgePoints[i], 0, 2 * (1 - std::cos(theta)) * std::sin(double(i) * theta));
  return mask;
}

TangentMask tangentMask(const Sector& s) {
  if (s.closed) return ringMask(s);
  if (s.faces == 1) return singleFaceMask(s);
  if (!s.crease) return cornerMask(s);
  return s.diagonalPoints.empty() ? triangleCreaseMask(s) : quadCreaseMask(s);
}

}  // namespace

struct CageLimit::Refined {
  struct SharpSide {
    uint32_t side;
    TangentMask mask;
  };
  std::unique_ptr<Far::TopologyRefiner> refiner;
  uint32_t points = 0, sides = 0;
  size_t cagePoints = 0;
  bool quads = true;
  // The first side of each point; the sides of the corners of all faces of the last level.
  std::vector<uint32_t> firstSide, sideOfCorner;
  std::vector<SharpSide> sharp;  // the sides to which OpenSubdiv's tangents do not apply

  explicit Refined(const SubdivisionCage& cage)
      : refiner(makeRefiner(cage)),
        cagePoints(cage.positions.size()),
        quads(cage.scheme == SubdivisionCage::Scheme::CatmullClark) {
    const TopologyLevel& level = last();
    points = uint32_t(level.GetNumVertices());
    firstSide.reserve(points);
    sideOfCorner.resize(size_t(level.GetNumFaceVertices()));
    for (int v = 0; v < int(points); ++v) findSides(level, v);
  }

  const TopologyLevel& last() const { return refiner->GetLevel(refiner->GetMaxLevel()); }
  size_t corners() const { return quads ? 4 : 3; }  // of a face

  void findSides(const TopologyLevel& level, int v) {
    const ConstIndexArray edges = level.GetVertexEdges(v), faces = level.GetVertexFaces(v);
    const auto inFace = level.GetVertexFaceLocalIndices(v);
    const Sdc::Crease::Rule rule = level.GetVertexRule(v);
    firstSide.push_back(sides);
    int sharpEdges = 0, start = 0;
    if (rule == Sdc::Crease::RULE_CREASE || rule == Sdc::Crease::RULE_CORNER)
      for (int i = edges.size() - 1; i >= 0; --i)
        if (level.GetEdgeSharpness(edges[i]) > 0) ++sharpEdges, start = i;
    const bool split = sharpEdges >= 2, closedRing = !split && rule == Sdc::Crease::RULE_CORNER;
    Sector sector;
    const auto close = [&] {
      sharp.push_back({sides, tangentMask(sector)});
      ++sides;
    };
    for (int n = 0; n < faces.size(); ++n) {
      const int i = (start + n) % faces.size();
      if (split && n > 0 && level.GetEdgeSharpness(edges[i]) > 0) {
        sector.edgePoints.push_back(across(level, edges[i], v));
        close();
        sector = {};
      }
      sideOfCorner[size_t(faces[i]) * corners() + inFace[i]] = sides;
      if (!split && !closedRing) continue;
      sector.vertex = v;
      sector.crease = rule == Sdc::Crease::RULE_CREASE;
      sector.closed = closedRing;
      ++sector.faces;
      sector.edgePoints.push_back(across(level, edges[i], v));
      if (quads) sector.diagonalPoints.push_back(level.GetFaceVertices(faces[i])[(inFace[i] + 2) & 3]);
    }
    if (!split && !closedRing) {
      ++sides;
      return;
    }
    // The ring of a boundary vertex has one edge more than faces; a closed ring returns to its first edge.
    if (split) sector.edgePoints.push_back(across(level, edges[(start + faces.size()) % edges.size()], v));
    close();
  }

  static int across(const TopologyLevel& level, int edge, int v) {
    const ConstIndexArray ends = level.GetEdgeVertices(edge);
    return ends[0] == v ? ends[1] : ends[0];
  }

  template <class Value>
  std::vector<Value> refined(std::vector<Value> values) const {
    const Far::PrimvarRefiner primvars(*refiner);
    for (int n = 1; n <= refiner->GetMaxLevel(); ++n) {
      std::vector<Value> next(size_t(refiner->GetLevel(n).GetNumVertices()));
      primvars.Interpolate(n, values, next);
      values = std::move(next);
    }
    return values;
  }

  // values: of the last level.
  template <class Value>
  Limits<Value> limits(const std::vector<Value>& values) const {
    Limits<Value> out;
    out.positions.resize(points);
    std::vector<Value> a(points), b(points);
    Far::PrimvarRefiner(*refiner).Limit(values, out.positions, a, b);
    out.tangentsA.resize(sides);
    out.tangentsB.resize(sides);
    for (uint32_t v = 0; v < points; ++v) {
      out.tangentsA[firstSide[v]] = std::move(a[v]);
      out.tangentsB[firstSide[v]] = std::move(b[v]);
    }
    for (const SharpSide& s : sharp) {
      out.tangentsA[s.side].Clear();
      out.tangentsB[s.side].Clear();
      for (const TangentMask::Term& t : s.mask.terms) {
        out.tangentsA[s.side].AddWithWeight(values[size_t(t.point)], t.a);
        out.tangentsB[s.side].AddWithWeight(values[size_t(t.point)], t.b);
      }
    }
    return out;
  }

  std::vector<glm::vec2> limitUvs(const std::vector<glm::vec2>& uvs) const {
    std::vector<Sum<glm::vec2>> values(uvs.size());
    for (size_t i = 0; i < uvs.size(); ++i) values[i].v = uvs[i];
    const Far::PrimvarRefiner primvars(*refiner);
    for (int n = 1; n <= refiner->GetMaxLevel(); ++n) {
      std::vector<Sum<glm::vec2>> next(size_t(refiner->GetLevel(n).GetNumFVarValues()));
      primvars.InterpolateFaceVarying(n, values, next);
      values = std::move(next);
    }
    std::vector<Sum<glm::vec2>> limit(values.size());
    primvars.LimitFaceVarying(values, limit);
    std::vector<glm::vec2> out(limit.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = limit[i].v;
    return out;
  }

  // Finds, in the last level, the corner of a face of some level at its point `point`. A corner is numbered face *
  // corners() + its place in the face.
  size_t lastCorner(int level, int face, int point) const {
    for (; level < refiner->GetMaxLevel(); ++level) {
      const TopologyLevel& now = refiner->GetLevel(level);
      const TopologyLevel& next = refiner->GetLevel(level + 1);
      point = now.GetVertexChildVertex(point);
      for (const int child : now.GetFaceChildFaces(face))
        if (placeIn(next.GetFaceVertices(child), point) >= 0) {
          face = child;
          break;
        }
    }
    return size_t(face) * corners() + size_t(placeIn(last().GetFaceVertices(face), point));
  }

  static int placeIn(const ConstIndexArray& points, int point) {
    for (int i = 0; i < points.size(); ++i)
      if (points[i] == point) return i;
    return -1;
  }

  std::vector<uint32_t> materials(const SubdivisionCage& cage) const {
    std::vector<uint32_t> values = cage.faceMaterials;
    const Far::PrimvarRefiner primvars(*refiner);
    for (int n = 1; !values.empty() && n <= refiner->GetMaxLevel(); ++n) {
      std::vector<uint32_t> next(size_t(refiner->GetLevel(n).GetNumFaces()));
      primvars.InterpolateFaceUniform(n, values, next);
      values = std::move(next);
    }
    return values;
  }
};

namespace {

// Vertices of one material: one for each texture coordinate of each side of a point.
class PartBuilder {
 public:
  explicit PartBuilder(uint32_t sides) : ofSide_(sides, kNoIndex) {}

  void begin() {
    for (const Known& k : known_) ofSide_[k.side] = kNoIndex;
    known_.clear();
  }

  uint32_t vertex(CageLimit::Part& part, const CageLimit::Vertex& v) {
    for (uint32_t i = ofSide_[v.side]; i != kNoIndex; i = known_[i].next)
      if (part.vertices[i].uv == v.uv) return i;
    const uint32_t index = uint32_t(part.vertices.size());
    part.vertices.push_back(v);
    known_.push_back({v.side, ofSide_[v.side]});
    ofSide_[v.side] = index;
    return index;
  }

 private:
  struct Known {
    uint32_t side, next;
  };
  std::vector<uint32_t> ofSide_;
  std::vector<Known> known_;
};

}  // namespace

CageLimit::CageLimit(const SubdivisionCage& cage) : refined_(std::make_unique<Refined>(cage)) {
  const TopologyLevel& level = refined_->last();
  const bool hasUvs = !cage.faceUvs.empty();
  const std::vector<uint32_t> materials = refined_->materials(cage);
  std::vector<uint32_t> order(size_t(level.GetNumFaces()));
  std::iota(order.begin(), order.end(), 0u);
  if (!materials.empty())
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return materials[a] < materials[b]; });
  PartBuilder builder(refined_->sides);
  const size_t corners = refined_->corners();
  std::vector<uint32_t> partOfFace(order.size()), vertexOfCorner(order.size() * corners);
  for (size_t n = 0; n < order.size(); ++n) {
    const uint32_t face = order[n], material = materials.empty() ? 0 : materials[face];
    if (n == 0 || material != parts_.back().material) {
      builder.begin();
      parts_.emplace_back().material = material;
    }
    Part& part = parts_.back();
    const ConstIndexArray points = level.GetFaceVertices(int(face));
    uint32_t* v = &vertexOfCorner[face * corners];
    for (size_t k = 0; k < corners; ++k)
      v[k] = builder.vertex(part, {uint32_t(points[int(k)]), refined_->sideOfCorner[face * corners + k],
                                   hasUvs ? uint32_t(level.GetFaceFVarValues(int(face))[int(k)]) : 0});
    part.indices.insert(part.indices.end(), {v[0], v[1], v[2]});
    if (corners == 4) part.indices.insert(part.indices.end(), {v[0], v[2], v[3]});
    partOfFace[face] = uint32_t(parts_.size() - 1);
  }
  if (!cage.lightLevel || *cage.lightLevel >= cage.level) return;
  // Each vertex of the coarse level becomes a vertex of the last one, with the same limit point.
  const TopologyLevel& coarse = refined_->refiner->GetLevel(int(*cage.lightLevel));
  std::vector<uint32_t> fan;
  for (int face = 0; face < coarse.GetNumFaces(); ++face) {
    fan.clear();
    size_t corner = 0;
    for (const int point : coarse.GetFaceVertices(face)) {
      corner = refined_->lastCorner(int(*cage.lightLevel), face, point);
      fan.push_back(vertexOfCorner[corner]);
    }
    std::vector<uint32_t>& indices = parts_[partOfFace[corner / corners]].lightIndices;
    for (size_t k = 2; k < fan.size(); ++k) indices.insert(indices.end(), {fan[0], fan[k - 1], fan[k]});
  }
}

CageLimit::~CageLimit() = default;

CageLimit::Surface CageLimit::surface(const std::vector<glm::vec3>& points,
                                      const std::vector<glm::vec2>& uvs) const {
  std::vector<Sum<glm::vec3>> values(points.size());
  for (size_t i = 0; i < points.size(); ++i) values[i].v = points[i];
  const Limits<Sum<glm::vec3>> limits = refined_->limits(refined_->refined(std::move(values)));
  const auto plain = [](const std::vector<Sum<glm::vec3>>& sums) {
    std::vector<glm::vec3> out(sums.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = sums[i].v;
    return out;
  };
  Surface out;
  out.positions = plain(limits.positions);
  out.tangentsA = plain(limits.tangentsA);
  out.tangentsB = plain(limits.tangentsB);
  if (!uvs.empty()) out.uvs = refined_->limitUvs(uvs);
  return out;
}

CageLimit::Rows CageLimit::rows() const {
  std::vector<SparseRow> values(refined_->cagePoints);
  for (size_t i = 0; i < values.size(); ++i) values[i].terms = {{uint32_t(i), 1.0f}};
  return refined_->limits(refined_->refined(std::move(values)));
}

#else

struct CageLimit::Refined {};

CageLimit::CageLimit(const SubdivisionCage&) {
  throw Error(ExitCode::BadInput, "subdivision surfaces are not part of this build of fovea",
              "build it with -DFOVEA_OPENSUBDIV=ON (Debian: libosd-dev)");
}
CageLimit::~CageLimit() = default;
CageLimit::Surface CageLimit::surface(const std::vector<glm::vec3>&, const std::vector<glm::vec2>&) const {
  return {};
}
CageLimit::Rows CageLimit::rows() const { return {}; }

#endif

}  // namespace fovea::scene
