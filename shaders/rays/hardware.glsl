// Rays through an acceleration structure, on devices with VK_KHR_ray_query. It is a part of rays/trace.glsl, which is
// what shaders include.
#ifndef FOVEA_RAYS_HARDWARE_GLSL
#define FOVEA_RAYS_HARDWARE_GLSL

layout(set = 1, binding = 11) uniform accelerationStructureEXT rayScene;  // an acceleration structure, with VK_KHR_ray_query
SCENE_TEXELS(12, uvec4, rayTriangles);  // the first entry of each instance, then entries: vertices, triangle, kRayHoles

// The entry of a primitive of an instance.
uvec4 rayTriangle(int instance, int primitive) {
  return texelOf(rayTriangles, int(texelOf(rayTriangles, 0)[instance]) + primitive);
}

// The nearest hit, or the first one found if `any` suffices.
RayHit trace(Ray ray, bool any) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, rayScene, any ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsNoneEXT, 0xffu,
                        ray.origin, ray.near, ray.direction, max(ray.far, ray.near));
  while (rayQueryProceedEXT(query)) {
    // The candidates are triangles that may have holes.
    uvec4 triangle = rayTriangle(rayQueryGetIntersectionInstanceIdEXT(query, false),
                                 rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    if (solidAt(triangle.w & ~kRayHoles, triangle, rayQueryGetIntersectionBarycentricsEXT(query, false)))
      rayQueryConfirmIntersectionEXT(query);
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT)
    return RayHit(kNoTriangle, ray.far, vec2(0.0));
  uvec4 triangle = rayTriangle(rayQueryGetIntersectionInstanceIdEXT(query, true),
                               rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
  return RayHit(triangle.w & ~kRayHoles, rayQueryGetIntersectionTEXT(query, true),
                rayQueryGetIntersectionBarycentricsEXT(query, true));
}

#endif
