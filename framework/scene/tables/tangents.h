// Tangents of meshes with normal maps.
#pragma once

#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

// The tangents of all triangles of a primitive, in the space of the mesh: those of the model, or else tangents made of
// the texture coordinates of `set` in the manner of MikkTSpace (Mikkelsen, "Simulation of Wrinkled Surfaces
// Revisited", 2008, section 4): each triangle gives its corners the direction of u, projected onto the plane of the
// vertex normal and weighted by the angle of the corner, and corners with the same position, normal and texture
// coordinates share the sum if their triangles have the same orientation in the texture. MikkTSpace also asks that
// such triangles are joined by edges, which is not tested here. Zeros where the texture coordinates give no direction.
std::vector<TriangleTangents> triangleTangents(const Primitive& primitive, uint32_t set);

// The same tangents for a triangle whose second and third vertex are exchanged, as they are where a transform turns
// the mesh inside out.
TriangleTangents turned(const TriangleTangents& tangents);

// The tangent at the barycentric weights u, v of the second and third vertex, not normalised. edgeB, edgeC: from the
// first vertex to the second and the third, wherever the triangle is now.
glm::vec3 tangentAt(const TriangleTangents& tangents, glm::vec3 edgeB, glm::vec3 edgeC, float u, float v);

}  // namespace fovea::scene
