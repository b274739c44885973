// Strategy `importance-area`: eye paths from the fixed screen points, one diffuse bounce each, the same ones as long
// as nothing moves. The paths of a point follow the R2 sequence (see points.comp) from a start of its own.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"
#include "vpls/paraboloid.glsl"
#include "sampling/diffuse_bounce.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer screen;
LARGE_TEXELS(vec4, radiance);
layout(std430) writeonly buffer EndsBlock { PathEnd list[]; } ends;

layout(push_constant) uniform Constants {
  uint points;
  uint paths;
};

const uint kPathStream = 0x70617468u;

void main() {
  uint path = gl_GlobalInvocationID.x;
  if (path >= paths) return;
  uint point = path % points, turn = path / points;
  EyePathStart from = loadStart(screen, point);
  PathEnd end = PathEnd(vec3(0.0), 0.0, vec3(0.0), 0.0);
  if (from.there > 0.0) {
    uint stream = randomStream(0u, 0u, kPathStream, point);
    vec2 u = vec2(uniformFloat(hashCombine(stream, 0u) + turn * 3242174889u),
                  uniformFloat(hashCombine(stream, 1u) + turn * 2447445414u));
    vec3 direction = diffuseBounce(from.normal, from.face, u);
    uint side = traceVoxels(voxelsGrid(), from.position, direction, from.face).side;
    if (side != kNoSide) {
      VoxelSide surface = loadSide(side);
      float light = texelOf(radiance, int(side)).w;
      light = light > 0.0 ? light : 0.0;  // excludes NaN
      end = PathEnd(surface.position, siteKind(light, luminanceOf(surface.emission)), surface.normal, light);
    }
  }
  ends.list[path] = end;
}
