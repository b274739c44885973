#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "common/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormal;
layout(location = 2) out vec2 outFace;
layout(location = 3) out vec4 outAlbedo;
layout(location = 4) out vec4 outEmission;
layout(location = 5) out uint outId;

void main() {
  uvec4 triangle = sceneTriangle(uint(gl_PrimitiveID));
  Material material = loadMaterial(materialOf(triangle));
#if CULL
  if (!gl_FrontFacing && !material.doubleSided) discard;
#endif
  SurfacePoint surface = surfaceAt(materialOf(triangle), uv);
  if (surface.alpha < material.alphaCutoff) discard;

  vec3 a = scenePosition(triangle.x);
  vec3 face = normalize(cross(scenePosition(triangle.y) - a, scenePosition(triangle.z) - a));
  if (dot(face, view.eye.xyz - a) < 0.0) face = -face;
  vec3 n = normalize(normal);
  if (dot(n, face) < 0.0) n = -n;

  outPosition = vec4(position, distance(position, view.eye.xyz));
  outNormal = vec4(n, 0.0);
  outFace = octEncode(face);
  outAlbedo = vec4(surface.reflectance, 0.0);
  outEmission = vec4(min(surface.emission, 65504.0), 0.0);
  outId = triangle.w;
}
