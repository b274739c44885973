// The bundles that passes hand to each other: their members are declared here, once, and passes name those they use.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/pass.h"

namespace fovea::passes {

// Members of the bundle `gbuffer`, all read in the same way: position, normal, face, albedo, emission, id, depth
// (described by pass gbuffer, which makes them).
std::vector<graph::MemberSpec> gbufferMembers(graph::Usage usage,
                                              std::initializer_list<std::string_view> names);

// Members of the bundle `voxels`: index, occupied, surface (described by pass voxelize) and info, which is read as a
// uniform or a texel buffer.
std::vector<graph::MemberSpec> voxelMembers(std::initializer_list<std::string_view> names,
                                            graph::Usage info = graph::Usage::Uniform);

// Members of the bundle `shadow-maps`, as pass shadow-map makes them.
std::vector<graph::MemberSpec> shadowMapMembers();

}  // namespace fovea::passes
