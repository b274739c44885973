// Holes of alpha-masked materials let light through. All other surfaces block it on both sides.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;

layout(push_constant) uniform Constants { uint firstTriangle; };

void main() {
  if (!alphaTest(materialOf(sceneTriangle(firstTriangle + uint(gl_PrimitiveID))), uv)) discard;
}
