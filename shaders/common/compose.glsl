// A complete fragment shader for the passes that end in an image: the irradiance of each pixel times its reflectance,
// plus direct light if HAS_DIRECT is 1.

layout(rgba16f) uniform readonly image2D gbufferAlbedo;
layout(rgba16f) uniform readonly image2D irradiance;  // background: 0
#if HAS_DIRECT
layout(rgba16f) uniform readonly image2D direct;
#endif

layout(location = 0) out vec4 indirect;
layout(location = 1) out vec4 radiance;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 reflected = imageLoad(gbufferAlbedo, p).rgb * imageLoad(irradiance, p).rgb, total = reflected;
#if HAS_DIRECT
  total += imageLoad(direct, p).rgb;
#endif
  indirect = vec4(reflected, 1.0);
  radiance = vec4(min(total, 65504.0), 1.0);
}
