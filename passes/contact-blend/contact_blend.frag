// Light by rays where there is some, else that of pass deferred.

layout(rgba16f) uniform readonly image2D light;
layout(rgba16f) uniform readonly image2D nearField;
layout(rgba16f) uniform readonly image2D irradiance;
layout(location = 0) out vec4 blended;

layout(push_constant) uniform Constants { float longer; };

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 found = imageLoad(light, p);
  vec3 all = min(found.rgb + imageLoad(nearField, p).rgb, 65504.0);
  blended = found.a > 0.0 ? vec4(all, longer) : vec4(imageLoad(irradiance, p).rgb, 1.0);
}
