// Reads the entry `subdivision` of a model in a scene file, which makes control cages of
// its meshes (samples/scenes/README.md).
#include <algorithm>

#include "framework/scene/file/reader.h"
#include "framework/scene/subdivision/cage_builder.h"

namespace fovea::scene {

using json::ObjectReader;
using json::Value;

namespace {

SubdivisionCage cageOfTriangles(const Mesh& mesh) {
  CageBuilder builder;
  for (const Primitive& p : mesh.primitives) {
    builder.begin(p);
    for (size_t i = 0; i + 2 < p.indices.size(); i += 3) builder.face(std::span(&p.indices[i], 3));
  }
  return builder.take();
}

}  // namespace

SubdivisionEntry readSubdivision(const Value& v, const std::string& path, Diagnostics& errors) {
  ObjectReader r(v, path, errors);
  SubdivisionEntry e;
  e.where = v.where.location();
  e.path = path;
  e.level = uint32_t(r.integer("level", 1, 1, SubdivisionCage::kMaxLevel));
  e.lightLevel = readLightLevel(r, "light_level", e.level);
  e.loop = r.choice("scheme", "loop", {"loop", "catmull-clark"}) == "loop";
  e.creaseDegrees = float(r.number("crease_deg", 180, 0, 180));
  if (const Value* list = r.array("meshes"))
    for (size_t i = 0; i < list->items.size(); ++i) {
      if (list->items[i].isString())
        e.meshes.push_back(list->items[i].string);
      else
        errors.error(list->items[i].where.location(), itemPath(r.pathOf("meshes"), i),
                     "expected the name of a mesh, found " + list->items[i].describe());
    }
  r.finish();
  return e;
}

void applySubdivision(const SubdivisionEntry& e, Scene& model) {
  const auto fail = [&](std::string message, std::string remedy) {
    throw Error(ExitCode::BadInput,
                {{Severity::Error, e.where, e.path, std::move(message), std::move(remedy)}});
  };
  std::vector<std::string> names;
  for (const Mesh& mesh : model.meshes) names.push_back(mesh.name);
  for (const std::string& name : e.meshes)
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      const std::string nearest = nearestName(name, names);
      fail("the model has no mesh `" + name + "`", nearest.empty() ? "" : "did you mean `" + nearest + "`?");
    }
  for (Mesh& mesh : model.meshes) {
    if (!e.meshes.empty() && std::find(e.meshes.begin(), e.meshes.end(), mesh.name) == e.meshes.end())
      continue;
    if (mesh.primitives.empty()) continue;
    SubdivisionCage cage = mesh.cage ? *mesh.cage : cageOfTriangles(mesh);
    cage.level = e.level;
    cage.lightLevel = e.lightLevel;
    if (!mesh.cage)
      cage.scheme = e.loop ? SubdivisionCage::Scheme::Loop : SubdivisionCage::Scheme::CatmullClark;
    const std::vector<CageProblem> problems = checkCage(cage);
    if (!problems.empty())
      fail("mesh `" + mesh.name + "` is no control cage: " + problems[0].place + ": " + problems[0].message,
           problems[0].place == "level" ? problems[0].remedy
                                        : "repair it, or list the meshes to subdivide in `meshes`");
    if (!mesh.cage && e.creaseDegrees < 180) creaseByAngle(cage, e.creaseDegrees);
    mesh.cage = std::make_shared<const SubdivisionCage>(std::move(cage));
    mesh.primitives.clear();
  }
  try {
    refineCages(model);
  } catch (const Error& error) {
    fail(error.diagnostics().front().message, error.diagnostics().front().remedy);
  }
}

}  // namespace fovea::scene
