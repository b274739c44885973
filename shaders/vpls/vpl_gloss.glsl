// The light of VPLs that a glossy surface reflects. A VPL stands for a disc of its area, as a virtual spherical light
// does for a ball (Hasan et al., "Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes", 2009): the lobe
// is widened by the solid angle of the disc, so that no VPL looks brighter than the surface it stands for.
//
// What is found is the mean of the light over the lobe, without Fresnel's factor, which hardly varies within a lobe and
// is applied where the picture is composed.
#ifndef FOVEA_VPL_GLOSS_GLSL
#define FOVEA_VPL_GLOSS_GLSL

#include "materials/gloss.glsl"

// The lobe of a dull dielectric reflects little, and hardly other light than its diffuse layer. From the first
// roughness to the second it passes over into that, and with the second VPLs need not be asked.
const float kDullFrom = 0.45, kDullTo = 0.6;

// Of Lobe::grazing: its value on a smooth surface, and the square of the roughness at which it has fallen to 1 / e.
// With these the layer gets the light that the exact BSDF (passes/path-trace/bsdf.h) lets through a dielectric
// with an index of refraction of 1.5, within 0.06 above a cosine of 0.1.
const float kLayerLoss = 0.87, kLayerLossEnd = 0.176;

// The lobe of a surface towards the eye.
struct Lobe {
  vec3 toEye;  // unit
  float a2;    // square of GGX's alpha
  float cosine;  // of the eye
  float masking, alpha2;  // for the masking: sqrt(alpha^2 + (1 - alpha^2) cosine^2), and alpha^2 as it was
  float albedo;   // of a mirror of this roughness, set by complete()
  float share;    // 0: the light is that of the diffuse layer, 1: that under the lobe
  float grazing;  // how much less of the light at grazing angles enters the diffuse layer, see responseTo()
};

// The lobe at a pixel. normal, specular: of the G-buffer; toEye: to the eye, of any length.
Lobe lobeOf(vec4 normal, vec3 toEye, vec4 specular) {
  Lobe l;
  l.toEye = normalize(toEye);
  l.cosine = max(dot(normal.xyz, l.toEye), 1e-3);
  float alpha = ggxAlpha(specular.a);
  l.a2 = alpha * alpha;
  l.alpha2 = l.a2;
  l.masking = sqrt(l.a2 + (1.0 - l.a2) * l.cosine * l.cosine);
  l.albedo = 1.0;
  bool metal = looksMetallic(specular);  // without a diffuse layer
  l.share = metal ? 1.0 : clamp((kDullTo - specular.a) / (kDullTo - kDullFrom), 0.0, 1.0);
  l.grazing = (metal ? 0.0 : l.share) * abs(normal.a) * kLayerLoss * exp(-specular.a * specular.a / kLayerLossEnd);
  return l;
}

// Neighbours of the same subset see other parts of a reflection where the surface is curved, and between them each VPL
// is evaluated at one pixel only. This widens a lobe for that, and completes it. turn2: squared difference between
// their normals, of which a quarter is about what makes their lobes overlap.
const float kSharpEdge = 0.25;  // squared difference between normals of two surfaces
void complete(inout Lobe l, float turn2) {
  l.albedo = mirrorAlbedo(l.cosine, sqrt(sqrt(l.alpha2))).all;
  l.a2 += 0.25 * turn2;
}

// What a surface makes of light from one direction. lobe: D V of GGX, per sr; layer: the share that enters the diffuse
// layer, over its mean for diffuse light.
struct Response {
  float lobe, layer;
};

// The response to a disc of `area` m^2 at the end of `toLight`, m, with height-correlated masking V (Heitz 2014).
// Simpler forms of V lose up to a seventh of the light. normal: unit.
//
// A disc fills the solid angle area / (d^2 + area / pi), as the kernel `disc` has it, and its halfway vectors a quarter
// of that, divided by the cosine between halfway vector and light. A lobe that is that much wider makes the disc as
// bright as a mirror would. With the square of this cosine, u / 2, it is dimmer at grazing angles and never brighter;
// l.a2 and what is added to it are multiplied by u.
//
// Fresnel's reflection leaves the diffuse layer little of the light at grazing angles: about a linear function of
// (1 - cosine)^4, whose mean over diffuse light is 1 / 15.
Response responseTo(Lobe l, vec3 normal, vec3 toLight, float area) {
  float d2 = max(dot(toLight, toLight), 1e-12), d = sqrt(d2);
  float facing = dot(normal, toLight);
  float inverse = 1.0 / d, u = max(1.0 + dot(l.toEye, toLight) * inverse, 1e-4), c = max(facing, 0.0) * inverse;
  float h2 = 2.0 * u, nh = c + l.cosine, nh2 = nh * nh;  // of the sum of both directions, which has the length sqrt(h2)
  float a2 = min(l.a2 * u + area / (2.0 * kPi * d2 + 2.0 * area), u);
  float s = max(h2 - nh2, 0.0) * u + nh2 * a2;
  float masking = c * l.masking + l.cosine * sqrt(l.alpha2 + (1.0 - l.alpha2) * c * c);
  float away = 1.0 - c, away2 = away * away;
  return Response(a2 * u * h2 * h2 * 0.5 / (kPi * s * s * masking), 1.0 + l.grazing * (1.0 / 15.0 - away2 * away2));
}

#endif
