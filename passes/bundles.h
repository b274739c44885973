// What passes exchange: the bundles and the buffers of records, each declared here once. The pass that makes a bundle
// gives its size and uses the whole declaration; a pass that reads it names the members that it uses and how it reads
// them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/pass.h"

namespace fovea::passes {

// Documentation of a counter of passes that trace single rays.
inline constexpr const char* kRaysDoc =
    "rays traced, including those from the eye and towards lights; on the device, one towards a light counts "
    "once however many panes it passes, and all rays of a first frame do";

// ---- Buffers of records ----------------------------------------------------------------------------------------

graph::ResourceSpec vplBuffer(const graph::SizeExpr& count = 1);        // scene::Vpl
graph::ResourceSpec vplStateBuffer(const graph::SizeExpr& count = 1);   // scene::VplState
graph::ResourceSpec candidateBuffer(const graph::SizeExpr& count = 1);  // scene::Candidate
// rgb: radiosity of a VPL, W/m^2; w: its luminance.
graph::ResourceSpec radiosityBuffer(const graph::SizeExpr& count = 1);
// rgb: radiance of a voxel side, W/(sr m^2); w: its luminance.
graph::ResourceSpec voxelRadianceBuffer(const graph::SizeExpr& count = 1);
// Foveated weight of a voxel side, in [0, 1].
graph::ResourceSpec voxelWeightBuffer(const graph::SizeExpr& count = 1);
// x: least area of a VPL's disc, y: that of a disc on an emissive surface, if it is larger, m^2.
graph::ResourceSpec spreadBuffer();
// x: share of the light that has changed since it was found last (the temporal gradient of Schied et al., "Gradient
// Estimation for Real-Time Adaptive Temporal Filtering", HPG 2018, for the whole region); y: s, after which a history
// of n samples is worth n / (1 + n s); z: the outdated share, from 0 to 1, which falls by a quarter in each frame
// after; w: share by which the light as a whole has grown or shrunk.
graph::ResourceSpec changeBuffer();

// ---- Bundles ---------------------------------------------------------------------------------------------------

// The bundle `gbuffer`: distance, camera, normal, face, albedo, emission, id, triangle, depth, specular (needs a
// parameter `materials`). usage: how a pass reads the images; `distance` is always a storage image, and
// `camera` is added to it, because SURFACES in shaders/screen/gbuffer.glsl needs both.
std::vector<graph::MemberSpec> gbufferOutput();
std::vector<graph::MemberSpec> gbufferMembers(graph::Usage usage,
                                              std::initializer_list<std::string_view> names);

// The bundle `voxels`: index, occupied, surface and info. A reader reads `info` as a uniform or a texel buffer.
// resolution: cells along an edge of the grid; room: voxels.
std::vector<graph::MemberSpec> voxelOutput(const graph::SizeExpr& resolution, const graph::SizeExpr& room);
std::vector<graph::MemberSpec> voxelMembers(std::initializer_list<std::string_view> names,
                                            graph::Usage info = graph::Usage::Uniform);

// The bundle `voxel-mips`: color, weight.
std::vector<graph::MemberSpec> voxelMipOutput(const graph::SizeExpr& width, const graph::SizeExpr& size,
                                              const graph::SizeExpr& levels);
std::vector<graph::MemberSpec> voxelMipMembers(std::initializer_list<std::string_view> names);

// The bundle `shadow-maps`: depth, views. size: of a map, texels.
std::vector<graph::MemberSpec> shadowMapOutput(const graph::SizeExpr& size, const graph::SizeExpr& layers);
std::vector<graph::MemberSpec> shadowMapMembers();

// The bundle `eye-paths`: starts, ends.
std::vector<graph::MemberSpec> eyePathOutput(const graph::SizeExpr& points, const graph::SizeExpr& paths,
                                             graph::Usage write);
std::vector<graph::MemberSpec> eyePathMembers();

// The bundle `shade-mask`: mask, blocks, dispatch. blocks: number of blocks of the image.
std::vector<graph::MemberSpec> shadeMaskOutput(const graph::SizeExpr& width, const graph::SizeExpr& height,
                                               const graph::SizeExpr& blocks);
std::vector<graph::MemberSpec> shadeMaskMembers();
std::vector<graph::MemberSpec> shadeMaskAlone(graph::Usage usage);

}  // namespace fovea::passes
