// The records that C++ and GLSL share have the same layout in both: every member of a storage buffer of them, as SPIR-V
// states it, lies where C++ puts it.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/gpu/shader/shader.h"
#include "passes/manage/records.h"
#include "passes/shadow-atlas/records.h"
#include "passes/voxelize/records.h"
#include "passes/vpl-intensity/records.h"
#include "places.h"
#include "shaders/records/eye_paths.h"
#include "shaders/records/light_paths.h"
#include "shaders/records/rays.h"
#include "shaders/records/reservoir.h"
#include "shaders/records/scene.h"
#include "shaders/records/shadow.h"
#include "shaders/records/voxel.h"
#include "shaders/records/vpl.h"

namespace fovea {
namespace {

// Member -> offset, of every struct that has offsets, by the struct's name.
using Layouts = std::map<std::string, std::map<std::string, size_t>>;

std::string textAt(const std::vector<uint32_t>& spirv, size_t word) {
  return reinterpret_cast<const char*>(&spirv[word]);
}

Layouts layoutsOf(const std::vector<uint32_t>& spirv) {
  constexpr uint32_t kName = 5, kMemberName = 6, kMemberDecorate = 72, kOffset = 35;
  std::map<uint32_t, std::string> names;
  std::map<std::pair<uint32_t, uint32_t>, std::string> members;
  std::map<std::pair<uint32_t, uint32_t>, size_t> offsets;
  for (size_t i = 5; i < spirv.size(); i += spirv[i] >> 16) {
    const uint32_t operation = spirv[i] & 0xffffu;
    if (operation == kName) names[spirv[i + 1]] = textAt(spirv, i + 2);
    if (operation == kMemberName) members[{spirv[i + 1], spirv[i + 2]}] = textAt(spirv, i + 3);
    if (operation == kMemberDecorate && spirv[i + 3] == kOffset)
      offsets[{spirv[i + 1], spirv[i + 2]}] = spirv[i + 4];
  }
  Layouts layouts;
  for (const auto& [member, offset] : offsets) layouts[names[member.first]][members[member]] = offset;
  return layouts;
}

// Compiles a shader with a buffer of two of these records and compares its layout with that of C++.
void expectLayout(const std::string& header, const std::string& record, size_t bytes,
                  const std::map<std::string, size_t>& members) {
  SCOPED_TRACE(record);
  gpu::ShaderCompiler compiler({});
  for (const char* folder : {"shaders", "passes"})
    compiler.addSearchPath(std::filesystem::path(FOVEA_SOURCE_DIR) / folder);
  const auto shader =
      compiler.compileSource(record + ".comp", "#include \"" + header +
                                                   "\"\n"
                                                   "layout(local_size_x = 1) in;\n"
                                                   "layout(std430) buffer Source { " +
                                                   record +
                                                   " list[2]; } source;\n"
                                                   "layout(std430) buffer Target { " +
                                                   record +
                                                   " list[2]; } target;\n"
                                                   "void main() { target.list = source.list; }\n");
  for (const gpu::ReflectedBinding& b : shader->reflection.bindings) EXPECT_EQ(b.blockBytes, 2 * bytes);
  EXPECT_EQ(shader->reflection.bindings.size(), 2u);
  EXPECT_EQ(layoutsOf(shader->spirv)[record], members);
}

#define AT(record, member) \
  { #member, offsetof(record, member) }

TEST(SharedRecords, Vpls) {
  using namespace scene;
  const char* header = "records/vpl.h";
  expectLayout(header, "Vpl", sizeof(Vpl),
               {AT(Vpl, position), AT(Vpl, area), AT(Vpl, normal), AT(Vpl, unused0), AT(Vpl, intensity),
                AT(Vpl, unused1)});
  expectLayout(header, "VplState", sizeof(VplState),
               {AT(VplState, position), AT(VplState, importance), AT(VplState, normal), AT(VplState, life),
                AT(VplState, reflectance), AT(VplState, side), AT(VplState, localPosition),
                AT(VplState, object), AT(VplState, localNormal), AT(VplState, previousImportance)});
  expectLayout(header, "Candidate", sizeof(Candidate),
               {AT(Candidate, position), AT(Candidate, side), AT(Candidate, normal), AT(Candidate, object),
                AT(Candidate, reflectance), AT(Candidate, luminance), AT(Candidate, localPosition),
                AT(Candidate, unused)});
}

TEST(SharedRecords, Voxels) {
  using namespace scene;
  const char* header = "records/voxel.h";
  expectLayout(header, "VoxelSide", sizeof(VoxelSide),
               {AT(VoxelSide, position), AT(VoxelSide, area), AT(VoxelSide, normal), AT(VoxelSide, object),
                AT(VoxelSide, reflectance), AT(VoxelSide, triangle), AT(VoxelSide, emission),
                AT(VoxelSide, emissionArea)});
  expectLayout(header, "VoxelInfo", sizeof(VoxelInfo),
               {AT(VoxelInfo, voxels), AT(VoxelInfo, staticVoxels), AT(VoxelInfo, overflow),
                AT(VoxelInfo, resolution)});
  using passes::voxelize::State;
  expectLayout("voxelize/records.h", "State", sizeof(State),
               {AT(State, chunkGroups), AT(State, chunks), AT(State, phases)});
}

TEST(SharedRecords, Scene) {
  using namespace scene;
  const char* header = "records/scene.h";
  expectLayout(header, "FrameBlock", sizeof(FrameBlock),
               {AT(FrameBlock, index),
                AT(FrameBlock, seed),
                AT(FrameBlock, lightCount),
                AT(FrameBlock, triangleCount),
                AT(FrameBlock, staticTriangleCount),
                AT(FrameBlock, vertexCount),
                AT(FrameBlock, time),
                AT(FrameBlock, exposure),
                AT(FrameBlock, boundsMin),
                AT(FrameBlock, preExposure),
                AT(FrameBlock, boundsMax),
                AT(FrameBlock, unused1),
                AT(FrameBlock, environment),
                AT(FrameBlock, environmentTurn),
                AT(FrameBlock, firstMovingVertex),
                AT(FrameBlock, firstMovingTriangle),
                AT(FrameBlock, firstSurface),
                AT(FrameBlock, firstAlbedo),
                AT(FrameBlock, firstTangent),
                AT(FrameBlock, firstDetail),
                AT(FrameBlock, transparent),
                AT(FrameBlock, unused2)});
  expectLayout(header, "ViewBlock", sizeof(ViewBlock),
               {AT(ViewBlock, worldToView), AT(ViewBlock, viewToClip), AT(ViewBlock, worldToClip),
                AT(ViewBlock, clipToWorld), AT(ViewBlock, previousWorldToClip), AT(ViewBlock, eye),
                AT(ViewBlock, unused0), AT(ViewBlock, gaze), AT(ViewBlock, jitterStep), AT(ViewBlock, size),
                AT(ViewBlock, inverseSize), AT(ViewBlock, rays)});
  expectLayout(header, "PixelRays", sizeof(PixelRays),
               {AT(PixelRays, eye), AT(PixelRays, unused0), AT(PixelRays, corner), AT(PixelRays, unused1),
                AT(PixelRays, right), AT(PixelRays, unused2), AT(PixelRays, down), AT(PixelRays, unused3)});
  expectLayout(
      header, "LightRecord", sizeof(LightRecord),
      {AT(LightRecord, position), AT(LightRecord, type), AT(LightRecord, direction), AT(LightRecord, range),
       AT(LightRecord, intensity), AT(LightRecord, firstShadowLayer), AT(LightRecord, cosInner),
       AT(LightRecord, cosOuter), AT(LightRecord, coneScale), AT(LightRecord, unused)});
  expectLayout(header, "ObjectRecord", sizeof(ObjectRecord),
               {AT(ObjectRecord, toWorld), AT(ObjectRecord, previousToWorld), AT(ObjectRecord, toObject),
                AT(ObjectRecord, visible), AT(ObjectRecord, wasVisible), AT(ObjectRecord, deforms),
                AT(ObjectRecord, unused)});
  expectLayout(header, "TextureRecord", sizeof(TextureRecord),
               {AT(TextureRecord, page), AT(TextureRecord, x), AT(TextureRecord, y), AT(TextureRecord, flags),
                AT(TextureRecord, size), AT(TextureRecord, offset), AT(TextureRecord, axisU),
                AT(TextureRecord, axisV)});
  expectLayout(header, "MaterialRecord", sizeof(MaterialRecord),
               {AT(MaterialRecord, baseColor), AT(MaterialRecord, alpha), AT(MaterialRecord, emission),
                AT(MaterialRecord, alphaCutoff), AT(MaterialRecord, colorTexture),
                AT(MaterialRecord, emissionTexture)});
  expectLayout(header, "SurfaceRecord", sizeof(SurfaceRecord),
               {AT(SurfaceRecord, baseColor), AT(SurfaceRecord, metallic), AT(SurfaceRecord, specularF0),
                AT(SurfaceRecord, specular), AT(SurfaceRecord, roughness), AT(SurfaceRecord, normalScale),
                AT(SurfaceRecord, transmission), AT(SurfaceRecord, unlit), AT(SurfaceRecord, clearcoat),
                AT(SurfaceRecord, clearcoatRoughness), AT(SurfaceRecord, unused0), AT(SurfaceRecord, unused1),
                AT(SurfaceRecord, metallicRoughnessTexture), AT(SurfaceRecord, normalTexture),
                AT(SurfaceRecord, specularTexture), AT(SurfaceRecord, specularColorTexture),
                AT(SurfaceRecord, transmissionTexture), AT(SurfaceRecord, clearcoatTexture),
                AT(SurfaceRecord, clearcoatRoughnessTexture)});
  expectLayout(header, "TangentRecord", sizeof(TangentRecord),
               {AT(TangentRecord, corner0), AT(TangentRecord, bitangentSign), AT(TangentRecord, corner1),
                AT(TangentRecord, unused0), AT(TangentRecord, corner2), AT(TangentRecord, unused1)});
  expectLayout(header, "VertexDetail", sizeof(VertexDetail),
               {AT(VertexDetail, color), AT(VertexDetail, uv), AT(VertexDetail, unused)});
  expectLayout("records/shadow.h", "ShadowView", sizeof(ShadowView),
               {AT(ShadowView, worldToClip), AT(ShadowView, right), AT(ShadowView, texelWidth),
                AT(ShadowView, up), AT(ShadowView, texelHeight), AT(ShadowView, bias),
                AT(ShadowView, relativeBias), AT(ShadowView, depthScale), AT(ShadowView, unused)});
}

TEST(SharedRecords, EyePaths) {
  using namespace passes;
  const char* header = "records/eye_paths.h";
  expectLayout(header, "EyePathStart", sizeof(EyePathStart),
               {AT(EyePathStart, position), AT(EyePathStart, there), AT(EyePathStart, normal),
                AT(EyePathStart, unused0), AT(EyePathStart, face), AT(EyePathStart, unused1)});
  expectLayout(header, "EyePathEnd", sizeof(EyePathEnd),
               {AT(EyePathEnd, position), AT(EyePathEnd, kind), AT(EyePathEnd, normal),
                AT(EyePathEnd, weight), AT(EyePathEnd, radiance), AT(EyePathEnd, unit)});
}

TEST(SharedRecords, LightPaths) {
  using passes::LightPaths;
  expectLayout(
      "records/light_paths.h", "LightPaths", sizeof(LightPaths),
      {AT(LightPaths, groupsX), AT(LightPaths, groupsY), AT(LightPaths, groupsZ), AT(LightPaths, first),
       AT(LightPaths, count), AT(LightPaths, paths), AT(LightPaths, stored), AT(LightPaths, full),
       AT(LightPaths, bounces), AT(LightPaths, lightPower), AT(LightPaths, power), AT(LightPaths, unused)});
}

TEST(SharedRecords, Rays) {
  using namespace scene;
  expectLayout("records/rays.h", "BvhNode", sizeof(BvhNode),
               {AT(BvhNode, low), AT(BvhNode, first), AT(BvhNode, high), AT(BvhNode, count)});
}

TEST(SharedRecords, Reservoirs) {
  using passes::Reservoir;
  expectLayout("records/reservoir.h", "Reservoir", sizeof(Reservoir),
               {AT(Reservoir, position), AT(Reservoir, count), AT(Reservoir, radiance), AT(Reservoir, weight),
                AT(Reservoir, normal), AT(Reservoir, mover)});
}

TEST(SharedRecords, OfOnePass) {
  using passes::manage::ManageState;
  using passes::manage::SlotRecord;
  const char* manage = "manage/records.h";
  expectLayout(manage, "ManageState", sizeof(ManageState),
               {AT(ManageState, occupied), AT(ManageState, alive), AT(ManageState, accepted),
                AT(ManageState, reused), AT(ManageState, oldCount), AT(ManageState, candidateCount)});
  expectLayout(
      manage, "SlotRecord", sizeof(SlotRecord),
      {AT(SlotRecord, importance), AT(SlotRecord, flags), AT(SlotRecord, cell), AT(SlotRecord, key)});
  using passes::intensity::PathSum;
  using passes::intensity::VplSite;
  const char* intensity = "vpl-intensity/records.h";
  expectLayout(intensity, "VplSite", sizeof(VplSite),
               {AT(VplSite, position), AT(VplSite, handicap), AT(VplSite, normal), AT(VplSite, light)});
  expectLayout(intensity, "PathSum", sizeof(PathSum),
               {AT(PathSum, paths), AT(PathSum, lightX), AT(PathSum, lightY), AT(PathSum, lightZ)});
  using passes::atlas::DrawnMap;
  using passes::atlas::Step;
  using passes::atlas::VplSet;
  using passes::atlas::VplView;
  const char* atlas = "shadow-atlas/records.h";
  expectLayout(atlas, "DrawnMap", sizeof(DrawnMap),
               {AT(DrawnMap, position), AT(DrawnMap, unused0), AT(DrawnMap, normal), AT(DrawnMap, unused1),
                AT(DrawnMap, movers), AT(DrawnMap, poses)});
  expectLayout(atlas, "VplView", sizeof(VplView),
               {AT(VplView, position), AT(VplView, slot), AT(VplView, tangent), AT(VplView, unused0),
                AT(VplView, bitangent), AT(VplView, unused1), AT(VplView, normal), AT(VplView, unused2)});
  expectLayout(atlas, "Step", sizeof(Step),
               {AT(Step, draw), AT(Step, large), AT(Step, maskedSmall), AT(Step, maskedLarge)});
  expectLayout(atlas, "VplSet", sizeof(VplSet), {AT(VplSet, triangle), AT(VplSet, vpls)});
}

}  // namespace
}  // namespace fovea
