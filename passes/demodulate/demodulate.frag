// Indirect radiance of Lambertian surfaces divided by their reflectance.
layout(rgba32f) uniform readonly image2D indirect;
layout(rgba16f) uniform readonly image2D gbufferAlbedo;
layout(location = 0) out vec4 irradiance;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 light = imageLoad(indirect, p).rgb, reflectance = imageLoad(gbufferAlbedo, p).rgb;
  irradiance = vec4(min(mix(vec3(0.0), light / reflectance, greaterThan(reflectance, vec3(0.0))), 65504.0), 1.0);
}
