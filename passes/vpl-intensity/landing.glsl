// The kernel of a density: how densely, per surface area in 1/m^2, eye paths from a screen point land on an
// unoccluded VPL. Needs scene/scene.glsl and vpl-intensity/vpl_intensity.glsl.
#ifndef FOVEA_LANDING_GLSL
#define FOVEA_LANDING_GLSL

uniform samplerBuffer screen;  // EyePathStart

// cos_s cos_l / (pi d^2 + area): the form factor of a disc of that area, seen along its axis, divided by the area.
// nearest, m: if above 0, smaller distances count as this one instead, as for the kernel `clamp`.
float landing(vec3 to, vec3 up, vec3 normal, float area, float nearest) {
  float d2 = dot(to, to), cosines = max(dot(up, to), 0.0) * max(-dot(normal, to), 0.0);
  float solid = nearest > 0.0 ? kPi * max(d2, nearest * nearest) : kPi * d2 + area;
  return cosines > 1e-12 * d2 && d2 > 1e-12 ? cosines / (d2 * solid) : 0.0;
}

float landing(uint point, vec3 position, vec3 normal, float area, float nearest) {
  EyePathStart from = loadStart(screen, point);
  float p = landing(position - from.position, from.normal, normal, area, nearest);
  return from.there > 0.0 ? p : 0.0;
}

#endif
