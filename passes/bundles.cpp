#include "passes/bundles.h"

#include "fovea/error.h"
#include "shaders/common/records/shadow.h"
#include "shaders/common/records/voxel.h"

namespace fovea::passes {

using namespace graph;

namespace {

std::vector<MemberSpec> choose(const std::vector<MemberSpec>& all,
                               std::initializer_list<std::string_view> names) {
  std::vector<MemberSpec> chosen;
  for (const std::string_view name : names)
    for (const MemberSpec& m : all)
      if (m.name == name) chosen.push_back(m);
  if (chosen.size() != names.size()) throw Error(ExitCode::Internal, "a bundle has no member of that name");
  return chosen;
}

}  // namespace

std::vector<MemberSpec> gbufferMembers(Usage usage, std::initializer_list<std::string_view> names) {
  return choose({member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), usage),
                 member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), usage),
                 member("face", image2D(VK_FORMAT_R16G16_SNORM), usage),
                 member("albedo", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), usage),
                 member("emission", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), usage),
                 member("id", image2D(VK_FORMAT_R32_UINT), usage),
                 member("depth", image2D(VK_FORMAT_D32_SFLOAT), usage)},
                names);
}

std::vector<MemberSpec> voxelMembers(std::initializer_list<std::string_view> names, Usage info) {
  const ResourceSpec cells = image3D(VK_FORMAT_R32_UINT, 1, 1, 1);
  return choose({member("index", cells, Usage::StorageRead), member("occupied", cells, Usage::StorageRead),
                 member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead),
                 member("info", buffer("VoxelInfo", sizeof(scene::VoxelInfo)), info)},
                names);
}

std::vector<MemberSpec> shadowMapMembers() {
  return {member("depth", image2DArray(VK_FORMAT_D32_SFLOAT, 1, 1, 1), Usage::Sampled),
          member("views", buffer("ShadowView", sizeof(scene::ShadowView)), Usage::Uniform)};
}

}  // namespace fovea::passes
