// Where light paths begin: the scene's lights and its emissive triangles, chosen in proportion to their power. A
// directional light sends a parallel beam over the silhouette of the scene's bounding box, so that nearly every ray
// meets the box; spot lights are sampled by their falloff.
#include "rays/surfaces.glsl"

// ---- Power ---------------------------------------------------------------------------------------------------------

// The area of each pair of the box's faces, times the cosine at which the beam meets it, m^2.
vec3 boxSilhouette(vec3 direction) {
  vec3 size = frame.boundsMax - frame.boundsMin;
  return abs(direction) * vec3(size.y * size.z, size.z * size.x, size.x * size.y);
}

// The falloff of a spot light, saturate((c - co) / (ci - co))^2, as a density over the cosine c: constant inside the
// inner cone, then a square, whose integral this is.
float softEdge(LightRecord light) { return (light.cosInner - light.cosOuter) / 3.0; }

// The power of a light, W per channel.
vec3 powerOf(LightRecord light) {
  if (light.type == kLightDirectional) return light.intensity * dot(boxSilhouette(light.direction), vec3(1.0));
  if (light.type == kLightPoint) return light.intensity * (4.0 * kPi);
  return light.intensity * (2.0 * kPi * ((1.0 - light.cosInner) + softEdge(light)));
}

// The power of one side of all emissive triangles, W, as the mean of the channels.
float emissivePower() { return emitterCount() > 0u ? kPi * emittersPower(1u) : 0.0; }

// ---- The start of a path -------------------------------------------------------------------------------------------

// The mean of `flux` over the starts is the power of the sources.
struct Emission {
  Ray ray;         // of unit direction
  vec3 flux;       // W per channel, if this were the only path
  float range;     // of the light, m, 0 if unlimited; its window applies at the first hit
  bool isSurface;  // the path starts on an emissive triangle, which gets a VPL
  vec3 normal;     // of that triangle on the emitting side
};

vec3 sphereDirection(vec2 u) {
  float z = 1.0 - 2.0 * u.x, r = sqrt(max(1.0 - z * z, 0.0)), phi = 2.0 * kPi * u.y;
  return vec3(r * cos(phi), r * sin(phi), z);
}

vec3 spotDirection(LightRecord light, vec2 u) {
  float edge = softEdge(light), x = u.x * (1.0 - light.cosInner + edge);
  float cosine = x >= edge ? min(light.cosInner + (x - edge), 1.0)
                           : light.cosOuter + (light.cosInner - light.cosOuter) * pow(x / edge, 1.0 / 3.0);
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0)), phi = 2.0 * kPi * u.y;
  return normalize(toWorld(orthonormalFrame(light.direction), vec3(sine * cos(phi), sine * sin(phi), cosine)));
}

// A point where the beam enters the box: on one of three faces, in proportion to their share of its cross-section.
vec3 beamStart(LightRecord light, vec3 u) {
  vec3 share = boxSilhouette(light.direction), low = frame.boundsMin, size = frame.boundsMax - low;
  float x = u.z * (share.x + share.y + share.z);
  int axis = x < share.x ? 0 : x < share.x + share.y || share.z <= 0.0 ? 1 : 2;
  vec3 p = low;
  p[axis] += light.direction[axis] > 0.0 ? 0.0 : size[axis];
  p[(axis + 1) % 3] += u.x * size[(axis + 1) % 3];
  p[(axis + 2) % 3] += u.y * size[(axis + 2) % 3];
  // Outside the box, so that scene geometry lying in the face of the box is hit as well.
  return p - light.direction * (0.01 * length(size));
}

// u: uniform in [0, 1). probability: with which this light was chosen.
Emission fromLight(LightRecord light, float probability, vec3 u) {
  vec3 flux = probability > 0.0 ? powerOf(light) / probability : vec3(0.0);
  vec3 start = light.position, direction = light.direction;
  if (light.type == kLightDirectional) start = beamStart(light, u);
  else if (light.type == kLightPoint) direction = sphereDirection(vec2(u));
  else direction = spotDirection(light, vec2(u));
  float range = light.type == kLightDirectional ? 0.0 : light.range;
  return Emission(Ray(start, direction, 0.0, kFarAway), flux, range, false, vec3(0.0));
}

// probability: with which any triangle was chosen. choice, u, turn_: uniform in [0, 1), for the triangle, for the point
// on it and its side, and for the direction.
Emission fromTriangle(float probability, float choice, vec3 u, vec2 turn_) {
  float own;
  Emitter e = emitterByPower(choice, own);
  EmitterPoint p = pointOn(wholeOf(e), vec2(u));
  vec3 normal = e.bothSides && u.z < 0.5 ? -e.normal : e.normal;
  float sides = e.bothSides ? 2.0 : 1.0, chosen = probability * own * p.density;
  vec3 flux = chosen > 0.0 ? p.radiance * (kPi * sides / chosen) : vec3(0.0);
  Ray ray = Ray(p.position + normal * rayEpsilon(), normalize(cosineDirection(normal, turn_)), 0.0, kFarAway);
  return Emission(ray, flux, 0.0, true, normal);
}
