// A complete fragment shader for passes that end in an image: the irradiance of each pixel times its reflectance, plus
// direct light. Outputs: `indirect` without, `radiance` with direct light, W/(sr m^2).
//
// Define: HAS_DIRECT 0/1, 1 adds the port `direct`; GLOSS, 0 for diffuse materials, 1 where the lobe of full materials
// reflects the port `gloss`, 2 where it reflects `irradiance` for want of that; REFLECTIONS 0/1, 1 where smooth
// surfaces reflect the port `reflections` instead.
//
// Needs the ports `gbuffer` and `irradiance`.
#if GLOSS
#include "materials/gloss.glsl"
#include "screen/gbuffer.glsl"
#endif

layout(rgba16f) uniform readonly image2D gbufferAlbedo;
layout(rgba16f) uniform readonly image2D irradiance;  // background: 0
#if GLOSS
SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rgba16f) uniform readonly image2D gbufferSpecular;
#if GLOSS == 1
layout(rgba16f) uniform readonly image2D gloss;  // background: 0
#endif
#if REFLECTIONS
layout(rgba16f) uniform readonly image2D reflections;  // a: 0 where there are none
#endif
#endif
#if HAS_DIRECT
layout(rgba16f) uniform readonly image2D direct;
#endif

layout(location = 0) out vec4 indirect;
layout(location = 1) out vec4 radiance;

// The whole shader.
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
#if GLOSS
  vec4 albedo = imageLoad(gbufferAlbedo, p), normal = imageLoad(gbufferNormal, p), light = imageLoad(irradiance, p);
  vec4 specular = imageLoad(gbufferSpecular, p);
  Gloss surface = glossOf(specular, normal.a, albedo.a, 0.04);
  float cosine = dot(normal.xyz, normalize(view.eye - surfaceAt(p).xyz));
  vec3 share = surfaceAlbedo(surface, mirrorAlbedo(cosine, surface.roughness), meanMirrorAlbedo(surface.roughness));
#if GLOSS == 1
  vec3 underLobe = imageLoad(gloss, p).rgb;
#else
  vec3 underLobe = light.rgb;
#endif
#if REFLECTIONS
  vec4 traced = imageLoad(reflections, p);
  underLobe = mix(underLobe, traced.rgb, traced.a > 0.0 ? tracedShare(specular) : 0.0);
#endif
  vec3 lit = albedo.rgb * light.rgb + share * underLobe, total = lit;
#else
  vec3 lit = imageLoad(gbufferAlbedo, p).rgb * imageLoad(irradiance, p).rgb, total = lit;
#endif
#if HAS_DIRECT
  total += imageLoad(direct, p).rgb;
#endif
  indirect = vec4(lit, 1.0);
  radiance = vec4(min(total, 65504.0), 1.0);
}
