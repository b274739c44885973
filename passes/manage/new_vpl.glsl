// The VPL that a candidate becomes, in its first frame. Needs scene/objects.glsl and vpls/vpl.glsl.
#ifndef FOVEA_MANAGE_NEW_VPL_GLSL
#define FOVEA_MANAGE_NEW_VPL_GLSL

uniform usamplerBuffer candidates;

// Normal in the space of its object, which is the world's if the object never moves.
vec3 localNormal(Candidate candidate) {
  uint object = uint(candidate.object);
  if (objectDeforms(object)) return candidate.normal * triangleAxes(uint(candidate.localPosition.x));
  return object == 0u ? candidate.normal : normalToObject(object, candidate.normal);
}

VplState newVpl(uint candidate, float importance) {
  Candidate c = loadCandidate(candidates, candidate);
  return VplState(c.position, importance, c.normal, 1.0, c.reflectance, c.side, c.localPosition, c.object,
                  localNormal(c), importance);
}

#endif
