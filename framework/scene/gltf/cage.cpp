// Reads control cages from glTF: `extras.fovea_subdivision` of a mesh's primitives. The triangles of the
// mesh are the faces of the cage cut into fans, so that other programs show the cage; quads are
// reassembled here (samples/scenes/README.md).
#include <tiny_gltf.h>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/subdivision/cage_builder.h"

namespace fovea::scene::gltf {
namespace {

using json::ObjectReader;
using json::Value;

constexpr const char* kName = "fovea_subdivision";

const Value* cageOf(const Value& primitive) {
  const Value* extras = primitive.find("extras");
  return extras && extras->isObject() ? extras->find(kName) : nullptr;
}

class CageReader {
 public:
  CageReader(const Value& primitives, std::string place)
      : primitives_(primitives), place_(std::move(place)) {}

  SubdivisionCage read(const std::vector<Primitive>& primitives) {
    if (primitives.size() != primitives_.items.size())
      fail(primitives_, place_, "all primitives of a mesh with a cage must be triangles with POSITION");
    for (size_t i = 0; i < primitives.size(); ++i) {
      const std::string path = place_ + ".primitives[" + std::to_string(i) + "]";
      const Value* v = cageOf(primitives_.items[i]);
      if (!v)
        fail(primitives_.items[i], path,
             std::string("has no extras.") + kName + ", other primitives of the mesh do",
             "the primitives of a mesh are one cage: all of them need it, or none");
      primitive(primitives[i], *v, path + ".extras." + kName);
    }
    const Value& first = *cageOf(primitives_.items.front());
    SubdivisionCage cage = builder_.take();
    cage.scheme = scheme_;
    cage.level = level_;
    cage.lightLevel = lightLevel_;
    cage.creases = std::move(creases_);
    cage.corners = std::move(corners_);
    const std::vector<CageProblem> problems = checkCage(cage);
    if (!problems.empty())
      fail(first, place_ + ": cage, " + problems[0].place, problems[0].message, problems[0].remedy);
    return cage;
  }

 private:
  [[noreturn]] void fail(const Value& v, std::string path, std::string message,
                         std::string remedy = {}) const {
    throw Error(ExitCode::BadInput, {{Severity::Error, v.where.location(), std::move(path),
                                      std::move(message), std::move(remedy)}});
  }

  void primitive(const Primitive& p, const Value& v, const std::string& path) {
    Diagnostics errors;
    ObjectReader r(v, path, errors);
    const std::string scheme = r.choice("scheme", "catmull-clark", {"catmull-clark", "loop"});
    const uint32_t level = uint32_t(r.integer("level", 2, 1, SubdivisionCage::kMaxLevel));
    const std::optional<uint32_t> lightLevel = readLightLevel(r, "lightLevel", level);
    const Value* sizes = r.find("faceSizes");
    const Value* creases = r.array("creases");
    const Value* corners = r.array("corners");
    r.finish();
    errors.throwIfErrors();
    const SubdivisionCage::Scheme chosen =
        scheme == "loop" ? SubdivisionCage::Scheme::Loop : SubdivisionCage::Scheme::CatmullClark;
    if (begun_ && (chosen != scheme_ || level != level_ || lightLevel != lightLevel_))
      fail(v, path, "differs in scheme, level or lightLevel from the mesh's first primitive",
           "the primitives of a mesh are one cage");
    begun_ = true;
    scheme_ = chosen;
    level_ = level;
    lightLevel_ = lightLevel;
    builder_.begin(p);
    faces(p, sizes, path + ".faceSizes");
    for (size_t i = 0; creases && i < creases->items.size(); ++i) {
      const Sharp s = sharp(p, creases->items[i], path + ".creases[" + std::to_string(i) + "]", 2);
      creases_.push_back({s.points[0], s.points[1], s.sharpness});
    }
    for (size_t i = 0; corners && i < corners->items.size(); ++i) {
      const Sharp s = sharp(p, corners->items[i], path + ".corners[" + std::to_string(i) + "]", 1);
      corners_.push_back({s.points[0], s.sharpness});
    }
  }

  // `sizes` gives the number of vertices per face: triangles if absent, one number for all faces, or one
  // number per face.
  void faces(const Primitive& p, const Value* sizes, const std::string& path) {
    const size_t triangles = p.indices.size() / 3;
    size_t next = 0;  // triangle
    for (size_t f = 0; sizes && sizes->isArray() ? f < sizes->items.size() : next < triangles; ++f) {
      const Value* size = sizes && sizes->isArray() ? &sizes->items[f] : sizes;
      const std::string place = size == sizes ? path : path + "[" + std::to_string(f) + "]";
      if (size && (!size->isInt() || size->integer < 3 || size->integer > SubdivisionCage::kMaxFaceSize))
        fail(*size, place,
             "expected a whole number from 3 to " + std::to_string(SubdivisionCage::kMaxFaceSize) +
                 ", found " + size->describe());
      const size_t count = size ? size_t(size->integer) : 3;
      if (count - 2 > triangles - next)
        fail(*size, place,
             "face " + std::to_string(f) + " takes " + std::to_string(count - 2) +
                 " triangles, but the primitive has only " + std::to_string(triangles - next) + " left");
      fan(p, next, count, size, place);
      next += count - 2;
    }
    if (next != triangles)
      fail(*sizes, path,
           "the faces take " + std::to_string(next) + " triangles, the primitive has " +
               std::to_string(triangles));
  }

  void fan(const Primitive& p, size_t firstTriangle, size_t count, const Value* size,
           const std::string& place) {
    const uint32_t* t = &p.indices[3 * firstTriangle];
    std::vector<uint32_t> corners = {t[0], t[1]};
    for (size_t i = 0; i + 2 < count; ++i, t += 3) {
      if (t[0] != corners[0] || t[1] != corners.back())
        fail(*size, place,
             "triangle " + std::to_string(firstTriangle + i) + " does not go on with the fan of its face",
             "write a face a, b, c, d, .. as the triangles a b c, a c d, ..");
      corners.push_back(t[2]);
    }
    builder_.face(corners);
  }

  struct Sharp {
    uint32_t points[2];
    float sharpness;
  };

  // Reads `count` vertices of the primitive and a sharpness.
  Sharp sharp(const Primitive& p, const Value& v, const std::string& path, size_t count) const {
    bool good = v.isArray() && v.items.size() == count + 1 && v.items[count].isNumber();
    Sharp s{};
    for (size_t i = 0; good && i < count; ++i) {
      good =
          v.items[i].isInt() && v.items[i].integer >= 0 && uint64_t(v.items[i].integer) < p.positions.size();
      if (good) s.points[i] = builder_.point(uint32_t(v.items[i].integer));
      good = good && s.points[i] != kNoIndex;
    }
    if (good && (v.items[count].real < 0 || v.items[count].real > 1e6)) good = false;
    if (!good)
      fail(v, path,
           std::string("expected ") + (count == 2 ? "[vertex, vertex, sharpness]" : "[vertex, sharpness]") +
               " with vertices of the primitive's faces and a sharpness from 0 (10: infinite)");
    s.sharpness = float(v.items[count].real);
    return s;
  }

  const Value& primitives_;
  const std::string place_;
  CageBuilder builder_;
  std::vector<SubdivisionCage::Crease> creases_;
  std::vector<SubdivisionCage::Corner> corners_;
  bool begun_ = false;
  SubdivisionCage::Scheme scheme_ = SubdivisionCage::Scheme::CatmullClark;
  uint32_t level_ = 2;
  std::optional<uint32_t> lightLevel_;
};

}  // namespace

bool hasCage(const json::Value& primitives) {
  for (const Value& p : primitives.items)
    if (cageOf(p)) return true;
  return false;
}

void buildCage(const json::Value& primitives, const std::string& place, Mesh& mesh) {
  mesh.cage = std::make_shared<const SubdivisionCage>(CageReader(primitives, place).read(mesh.primitives));
  mesh.primitives.clear();
}

void refineCages(Context& c) {
  try {
    scene::refineCages(c.scene);
  } catch (const Error& e) {
    c.fail("meshes", e.diagnostics().front().message, e.diagnostics().front().remedy);
  }
}

}  // namespace fovea::scene::gltf
