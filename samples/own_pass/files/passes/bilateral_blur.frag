// One direction of the blur: a mean of the neighbours that lie on the pixel's own surface. Define: COLUMNS 0/1.
#include "screen/gbuffer.glsl"

#if COLUMNS
uniform texture2D rows;
#define SOURCE rows
const ivec2 kStep = ivec2(0, 1);
#else
uniform texture2D picture;
#define SOURCE picture
const ivec2 kStep = ivec2(1, 0);
#endif
SURFACES(gbuffer, surfaceAt)
uniform texture2D gbufferNormal;

layout(push_constant) uniform Constants {
  int radius;
  float planeTolerance;
};

layout(location = 0) out vec4 blurred;

// Whether pixel q shows the surface whose point and normal are given.
bool sameSurface(ivec2 q, vec4 position, vec3 normal) {
  vec3 apart = surfaceAt(q).xyz - position.xyz;
  bool turned = dot(texelFetch(gbufferNormal, q, 0).xyz, normal) < 0.9;
  return !turned && abs(dot(apart, normal)) <= planeTolerance * position.w;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = textureSize(SOURCE, 0);
  vec4 position = surfaceAt(p);
  vec3 normal = texelFetch(gbufferNormal, p, 0).xyz;
  vec4 sum = texelFetch(SOURCE, p, 0);
  float count = 1.0;
  for (int i = -radius; i <= radius && position.w > 0.0; ++i) {
    ivec2 q = p + i * kStep;
    if (i == 0 || any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size))) continue;
    if (!sameSurface(q, position, normal)) continue;
    sum += texelFetch(SOURCE, q, 0);
    count += 1.0;
  }
  blurred = sum / count;
}
