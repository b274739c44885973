// The lobe in which a surface that the eye sees reflects light, by what the G-buffer keeps of it.
#include "materials/gloss.glsl"

IMAGE(rgba16f, readonly, image2D, gbufferNormal);
IMAGE(rgba16f, readonly, image2D, gbufferSpecular);

struct ReceiverLobe {
  vec3 normal, out_;  // unit; out_: to the eye, not behind the surface
  float roughness;
  // Factors on what microfacets reflect of light that they scatter once, and on what they lose of it and scatter more
  // than once; both 0 if there is no lobe.
  float once, more;
};

// position: of the surface at the pixel.
ReceiverLobe receiverLobe(ivec2 pixel, vec3 position) {
  vec4 specular = imageLoad(gbufferSpecular, pixel);
  vec3 normal = normalize(vec3(imageLoad(gbufferNormal, pixel))), out_ = normalize(view.eye - position);
  if (vec3(specular) == vec3(0.0)) return ReceiverLobe(normal, out_, 1.0, 0.0, 0.0);
  float facing = dot(normal, out_);
  if (facing < kLeastLobe) out_ = normalize(out_ + (kLeastLobe - facing) * normal);
  // What is smoother than this is traced (pass mirrors).
  float roughness = max(specular.a, looksMetallic(specular) ? kTracedMetal : kTracedDielectric);
  float once = mirrorAlbedo(dot(normal, out_), roughness).all, mean = meanMirrorAlbedo(roughness).all;
  // With the mean of the channels for a reflectance that is the same from everywhere.
  float fresnel = min(dot(vec3(specular), vec3(1.0 / 3.0)), 1.0);
  float more = lostAlbedo(vec3(fresnel), mean).x * (1.0 - once);
  float all = max(fresnel * once + more, kLeastLobe * fresnel);
  return ReceiverLobe(normal, out_, roughness, kPi * fresnel / all, more / (all * max(1.0 - mean, kLeastLobe)));
}

// What light from a direction, which is unit, adds to the mean of the light under the lobe for each unit of
// irradiance / pi that it adds. cosine: by which that irradiance counts; its normal may not be that of shading.
float response(ReceiverLobe lobe, vec3 direction, float cosine) {
  if (lobe.once == 0.0) return 1.0;
  float bent = dot(lobe.normal, direction);
  if (bent <= 0.0) return 0.0;
  vec3 halfway = normalize(direction + lobe.out_);
  float reflects = lobe.once * ggxReflection(lobe.normal, direction, lobe.out_, halfway, ggxAlpha(lobe.roughness)) +
                   lobe.more * (1.0 - mirrorAlbedo(bent, lobe.roughness).all);
  return reflects * bent / max(cosine, kLeastReceived);
}
