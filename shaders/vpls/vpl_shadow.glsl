// Whether a point is in the shadow of a VPL.
//
// Needs vpls/paraboloid.glsl.
#ifndef FOVEA_VPL_SHADOW_GLSL
#define FOVEA_VPL_SHADOW_GLSL

// Whether a VPL sees a point, by the distance in its paraboloid map and the one that it must hold for the point to be
// lit.
//
// The map holds the distance along the direction of a texel's centre, but the point lies anywhere in the texel.
// Comparing with the distance at which the centre's ray meets the tangent plane of the point removes the slope from
// the comparison; a fixed slope-scaled bias would have to cover the whole footprint. Where the ray meets the plane
// behind the point (or runs along it), another surface may stand there, so the limit is the point's own distance and
// no false shadow appears.
//
// stored: value of the map; height: of the point along `face`, from the VPL (negative where the face looks at it);
// len: distance of the point; ahead: len plus the distance along the VPL's normal; face: unit normal of the point's
// triangle on the visible side, in the VPL's frame; bias: in half widths of a texel there, 1 by default, for
// curvature and small detail within a texel. Against traced rays with maps of 128 x 128 texels, weighted by light,
// this loses 0.3% in the Cornell box and 4.0% in Sponza to false shadows and gains 0.6% and 4.6% by leaks, so
// brightness is nearly preserved. (A bias for the whole slope loses 3.1% and gains 7.0% in Sponza.)
bool vplSees(float stored, float height, float len, float ahead, vec3 face, ivec2 texel, int size, float bias) {
  // The centre's direction is (2q, 1 - q.q) / (1 + q.q), see paraboloidDirection; its length cancels
  // except in one place.
  vec2 q = paraboloidTexelCentre(texel, size);
  float qq = dot(q, q);
  float facing = -(2.0 * dot(face.xy, q) + face.z * (1.0 - qq));
  // Angular width of a texel: (2 / size) (1 + z).
  float held = stored + bias * (ahead / float(size) + 1e-3);
  return held >= len || (facing > 1e-3 && held * facing >= -height * (1.0 + qq));
}

#endif
