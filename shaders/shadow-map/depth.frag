// Holes of alpha-masked materials let light through. Both sides of all others stop it, as they do in every renderer here.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;

layout(push_constant) uniform Constants { uint firstTriangle; };

void main() {
  if (!alphaTest(materialOf(sceneTriangle(firstTriangle + uint(gl_PrimitiveID))), uv)) discard;
}
