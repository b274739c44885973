// Whether another pixel shows the surface that one shows.
// position, m; face: normal of the plane that the other has to lie near, normal: the one that its own may differ from;
// other: xyz: m, w: above 0 unless it is background; tolerance: distance from the plane, m.
bool sameSurface(vec3 position, vec3 face, vec3 normal, vec4 other, vec3 otherNormal, float tolerance, float leastCos) {
  return other.w > 0.0 && abs(dot(other.xyz - position, face)) <= tolerance && dot(normal, otherNormal) >= leastCos;
}
