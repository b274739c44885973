#include "passes/bundles.h"

#include <algorithm>

#include "fovea/error.h"
#include "passes/materials.h"
#include "shaders/records/eye_paths.h"
#include "shaders/records/scene.h"
#include "shaders/records/shadow.h"
#include "shaders/records/voxel.h"
#include "shaders/records/vpl.h"

namespace fovea::passes {

using namespace graph;

namespace {

constexpr uint32_t kTexel = 16;  // bytes of a vec4

// The member of a bundle that a pass reads in this way. Its content is documented where it is made.
MemberSpec read(const std::vector<MemberSpec>& output, std::string_view name, Usage usage) {
  for (const MemberSpec& m : output)
    if (m.name == name) return member(m.name, m.resource, usage);
  throw Error(ExitCode::Internal, "no bundle has a member `" + std::string(name) + "` here");
}

std::vector<MemberSpec> read(const std::vector<MemberSpec>& output,
                             std::initializer_list<std::string_view> names, Usage usage) {
  std::vector<MemberSpec> members;
  for (const std::string_view name : names) members.push_back(read(output, name, usage));
  return members;
}

}  // namespace

// ---- Buffers of records ----------------------------------------------------------------------------------------

ResourceSpec vplBuffer(const SizeExpr& count) { return buffer("Vpl", sizeof(scene::Vpl), count); }
ResourceSpec vplStateBuffer(const SizeExpr& count) {
  return buffer("VplState", sizeof(scene::VplState), count);
}
ResourceSpec candidateBuffer(const SizeExpr& count) {
  return buffer("Candidate", sizeof(scene::Candidate), count);
}
ResourceSpec radiosityBuffer(const SizeExpr& count) { return buffer("VplRadiosity", kTexel, count); }
ResourceSpec voxelRadianceBuffer(const SizeExpr& count) { return buffer("VoxelRadiance", kTexel, count); }
ResourceSpec voxelWeightBuffer(const SizeExpr& count) { return buffer("VoxelWeight", sizeof(float), count); }
ResourceSpec spreadBuffer() { return buffer("VplSpread", kTexel); }
ResourceSpec changeBuffer() { return buffer("LightChange", kTexel); }

// ---- Bundles ---------------------------------------------------------------------------------------------------

std::vector<MemberSpec> gbufferOutput() {
  const SizeExpr full = fullMaterials();
  return {
      member("distance", image2D(VK_FORMAT_R32_SFLOAT), Usage::ColorAttachment,
             "distance from the eye to the surface, m, along the ray that `camera` gives for the pixel's "
             "centre (surfaceAt() in shaders/screen/gbuffer.glsl); background 0"),
      member("camera", buffer("PixelRays", sizeof(scene::PixelRays)), Usage::StorageWrite,
             "the eye and the rays through the pixels"),
      member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::ColorAttachment,
             "xyz: unit shading normal, on the side of the face towards the eye; a: with full materials, the "
             "reflectance of the surface at grazing incidence, negative where the pixel may show another "
             "surface in the next frame, as one of them is transparent"),
      member("face", image2D(VK_FORMAT_R16G16_SNORM), Usage::ColorAttachment,
             "geometric normal on the side towards the eye, octahedral encoding"),
      member("albedo", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::ColorAttachment,
             "rgb: diffuse reflectance, base colour times (1 - metallic); with full materials, that of the "
             "diffuse layer as seen from the eye, and a: the metallic share of the surface"),
      member(
          "emission", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT)), Usage::ColorAttachment,
          "rgb: emitted radiance, W/(sr m^2), in the background the environment; a: with full materials, the "
          "mean of the channels of `specular` for the dielectric part"),
      member("id", image2D(VK_FORMAT_R32_UINT), Usage::ColorAttachment,
             "material | object << 16; background 0xffffffff"),
      member("triangle", image2D(VK_FORMAT_R32_UINT), Usage::ColorAttachment | Usage::Sampled,
             "number of the triangle in the scene; background 0xffffffff"),
      member("depth", image2D(VK_FORMAT_D32_SFLOAT), Usage::DepthAttachment, "0: near plane, 1: far plane"),
      member("specular",
             image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(full * viewWidth(), 1), max(full * viewHeight(), 1)),
             Usage::ColorAttachment,
             "with full materials, rgb: reflectance of the surface at normal incidence, a: roughness (the "
             "square root of GGX's alpha); otherwise one undefined texel")};
}
std::vector<MemberSpec> gbufferMembers(Usage usage, std::initializer_list<std::string_view> names) {
  const std::vector<MemberSpec> output = gbufferOutput();
  std::vector<MemberSpec> members = read(output, names, usage);
  for (MemberSpec& m : members)
    if (m.name == "distance") m.usage = Usage::StorageRead;
  if (std::ranges::find(names, "distance") != names.end())
    members.push_back(read(output, "camera", Usage::StorageRead));
  return members;
}

std::vector<MemberSpec> voxelOutput(const SizeExpr& r, const SizeExpr& room) {
  return {member("index", image3D(VK_FORMAT_R32_UINT, r, r, r), Usage::StorageRead | Usage::StorageWrite,
                 "0 if the cell is empty, else 1 + number of its voxel"),
          member("occupied",
                 image3D(VK_FORMAT_R32_UINT, ceilDiv(r, scene::kBrickWidth), ceilDiv(r, scene::kBrickHeight),
                         ceilDiv(r, scene::kBrickDepth)),
                 Usage::StorageRead | Usage::StorageWrite,
                 "one bit for each cell of a brick of 4 x 4 x 2 cells: it holds a voxel"),
          member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide), room * 2), Usage::StorageWrite,
                 "two sides per voxel, see shaders/voxels/voxel.glsl; a side with area 0 is empty"),
          member("info", buffer("VoxelInfo", sizeof(scene::VoxelInfo)),
                 Usage::StorageRead | Usage::StorageWrite, "numbers of voxels")};
}
std::vector<MemberSpec> voxelMembers(std::initializer_list<std::string_view> names, Usage info) {
  const std::vector<MemberSpec> output = voxelOutput(1, 1);
  std::vector<MemberSpec> members;
  for (const std::string_view name : names)
    members.push_back(read(output, name,
                           name == "info"      ? info
                           : name == "surface" ? Usage::TexelRead
                                               : Usage::StorageRead));
  return members;
}

std::vector<MemberSpec> voxelMipOutput(const SizeExpr& width, const SizeExpr& size, const SizeExpr& levels) {
  return {member("color", ofLight(image3D(VK_FORMAT_R16G16B16A16_SFLOAT, width, size, size, levels)),
                 Usage::StorageRead | Usage::StorageWrite,
                 "rgb: radiance times a; a: surface area relative to the area of a cell's face, over 1 "
                 "where a cell holds several surfaces"),
          member("weight", image3D(VK_FORMAT_R16_SFLOAT, width, size, size, levels),
                 Usage::StorageRead | Usage::StorageWrite, "foveated weight times a of `color`")};
}
std::vector<MemberSpec> voxelMipMembers(std::initializer_list<std::string_view> names) {
  return read(voxelMipOutput(1, 1, 1), names, Usage::Sampled);
}

std::vector<MemberSpec> shadowMapOutput(const SizeExpr& size, const SizeExpr& layers) {
  return {member("depth", image2DArray(VK_FORMAT_D32_SFLOAT, size, size, layers),
                 Usage::DepthAttachment | Usage::TransferWrite,
                 "depth, 1 nearest to the light, 0 where nothing is hit; layers in the order of the lights"),
          member("views", buffer("ShadowView", sizeof(scene::ShadowView), scene::kMaxShadowLayers),
                 Usage::StorageWrite | Usage::Uniform,
                 "projection of each layer (shaders/vpls/shadow.glsl); unused entries are undefined")};
}
std::vector<MemberSpec> shadowMapMembers() {
  const std::vector<MemberSpec> output = shadowMapOutput(1, 1);
  return {read(output, "depth", Usage::Sampled), read(output, "views", Usage::Uniform)};
}

std::vector<MemberSpec> eyePathOutput(const SizeExpr& points, const SizeExpr& paths, Usage write) {
  return {member("starts", buffer("ScreenPoint", sizeof(EyePathStart), points), write),
          member("ends", buffer("EyePathEnd", sizeof(EyePathEnd), paths), write)};
}
std::vector<MemberSpec> eyePathMembers() {
  return read(eyePathOutput(1, 1, Usage::None), {"starts", "ends"}, Usage::TexelRead);
}

std::vector<MemberSpec> shadeMaskOutput(const SizeExpr& width, const SizeExpr& height,
                                        const SizeExpr& blocks) {
  return {member("mask", image2D(VK_FORMAT_R8_UNORM, width, height),
                 Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
                 "1 if the pixel is in a block to shade"),
          member("blocks", buffer("ShadeBlock", 4, blocks), Usage::StorageWrite,
                 "x | y << 16 of each block to shade, in blocks of `interleave` pixels; in a fixed order"),
          member("dispatch", buffer("ShadeDispatch", 16), Usage::StorageWrite,
                 "groups of an indirect dispatch, with a column for 256 blocks and a row for each pixel of a "
                 "block; w: number of blocks")};
}
std::vector<MemberSpec> shadeMaskMembers() {
  const std::vector<MemberSpec> output = shadeMaskOutput(1, 1, 1);
  return {read(output, "mask", Usage::StorageRead), read(output, "blocks", Usage::TexelRead),
          read(output, "dispatch", Usage::TexelRead | Usage::Indirect)};
}
std::vector<MemberSpec> shadeMaskAlone(Usage usage) {
  return read(shadeMaskOutput(1, 1, 1), {"mask"}, usage);
}

}  // namespace fovea::passes
