// Whether another pixel shows the same surface. position: of the pixel, m; face: normal of the plane near which the
// other point must lie; normal: normal from which the other's may differ only so much; other: xyz: m, w: above 0
// unless background; tolerance: distance from the plane, m.
bool sameSurface(vec3 position, vec3 face, vec3 normal, vec4 other, vec3 otherNormal, float tolerance, float leastCos) {
  return other.w > 0.0 && abs(dot(other.xyz - position, face)) <= tolerance && dot(normal, otherNormal) >= leastCos;
}
