// Emissive triangles and the environment map as light sources that rays are aimed at. A triangle is chosen by a walk
// down a binary tree, at each node with the probability of the light that its halves may send to the receiver, as
// bounded by boxes and cones of normals (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting", HPG 2018).
//
// Define: RAY_PASSAGE (rays/trace.glsl).
#ifndef FOVEA_RAYS_EMITTERS_GLSL
#define FOVEA_RAYS_EMITTERS_GLSL

#include "materials/passage.glsl"
#include "rays/trace.glsl"
#include "records/emitters.h"

SCENE_TEXELS(13, uvec4, rayEmitters);  // emissive triangles, and tables of the map (records/emitters.h)

// The surface that is lit.
struct Receiver {
  vec3 position;  // world space, m
  vec3 normal;    // unit
};

// The EmitterHeader, and the number of emissive triangles.
uvec4 emitterHeader() { return texelOf(rayEmitters, 0); }
uint emitterCount() { return emitterHeader().x; }

// ---- Bounds of the light that emitters send ------------------------------------------------------------------------

// An emissive triangle. power: W / pi, mean of the channels; area: m^2; centre: world space, m; normal: unit.
struct Emitter {
  uint triangle;
  bool bothSides;
  float power, area, radius2;  // radius2: squared distance of the farthest corner from the centre, m^2
  vec3 centre, normal;
};

// The corners of a triangle, world space, m; their mean; and the largest squared distance of one of them from it, m^2.
mat3 cornersOf(uint triangle) {
  uvec4 vertices = sceneTriangle(triangle);
  return mat3(scenePosition(vertices.x), scenePosition(vertices.y), scenePosition(vertices.z));
}
vec3 meanOf(mat3 corners) { return (corners[0] + corners[1] + corners[2]) / 3.0; }
float radius2Around(mat3 corners, vec3 centre) {
  vec3 a = corners[0] - centre, b = corners[1] - centre, c = corners[2] - centre;
  return max(dot(a, a), max(dot(b, b), dot(c, c)));
}

// The emissive triangle at a place in the order of the leaves.
Emitter emitterAt(uint place) {
  uvec4 record = texelOf(rayEmitters, int(1u + place));
  uint index = record.x & ~kEmitterBothSides;
  mat3 corners = cornersOf(index);
  vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]), centre = meanOf(corners);
  float twice = length(across), area = 0.5 * twice;
  vec3 normal = twice > 0.0 ? across / twice : vec3(0.0);
  float radius2 = radius2Around(corners, centre);
  return Emitter(index, record.x != index, uintBitsToFloat(record.y) * area, area, radius2, centre, normal);
}

// Power of the sides that emit, W / pi.
float powerOfSides(Emitter e) { return e.bothSides ? 2.0 * e.power : e.power; }

// An angle from 0 to pi. x: its cosine, y: its sine. angleLess() is a - b, or 0 if that is negative.
vec2 angleOf(float cosine) { return vec2(cosine, sqrt(max(1.0 - cosine * cosine, 0.0))); }
vec2 angleLess(vec2 a, vec2 b) {
  if (a.x >= b.x) return vec2(1.0, 0.0);
  return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}

// In proportion to a bound of the light that a node, or a triangle, sends to the receiver; 0 if it sends none.
float nodeWeight(uint node, Receiver r) {
  int first = int(emitterHeader().y + 3u * node);
  vec4 sphere = uintBitsToFloat(texelOf(rayEmitters, first)), cone = uintBitsToFloat(texelOf(rayEmitters, first + 1));
  float power = uintBitsToFloat(texelOf(rayEmitters, first + 2).x);
  vec3 to = r.position - vec3(sphere);
  float d2 = dot(to, to);
  if (d2 <= sphere.w) return power / max(sphere.w, 1e-20);
  float inverse_ = inversesqrt(d2), sine = sqrt(sphere.w) * inverse_;
  vec2 bounds = vec2(sqrt(max(1.0 - sine * sine, 0.0)), sine);
  float emitting = angleLess(angleLess(angleOf(dot(to, vec3(cone)) * inverse_), angleOf(cone.w)), bounds).x;
  float receiving = angleLess(angleOf(-dot(to, r.normal) * inverse_), bounds).x;
  if (emitting < -kConeRounding || receiving < -kConeRounding) return 0.0;
  return power * max(emitting, kLeastEmitterCosine) * max(receiving, kLeastEmitterCosine) / d2;
}

// The same for a triangle.
float emitterWeight(Emitter e, Receiver r) {
  vec3 to = r.position - e.centre;
  float above = dot(to, e.normal);
  if (!e.bothSides && !(above > 0.0)) return 0.0;
  float d2 = max(dot(to, to), max(kNearPiece * e.radius2, 1e-20)), d = sqrt(d2), radius = sqrt(e.radius2);
  float receiving = radius - dot(to, r.normal);
  if (receiving < -kConeRounding * d) return 0.0;
  float emitting = min(abs(above) + 0.1 * radius, d), least = kLeastEmitterCosine * d;
  return e.power * max(emitting, least) * max(min(receiving, d), least) / (d2 * d2);
}

// ---- The tree ------------------------------------------------------------------------------------------------------

// The probability of turning to the first half of a node, below 0 if neither half sends light.
float firstHalf(uint node, Receiver r) {
  float first = nodeWeight(2u * node, r), second = nodeWeight(2u * node + 1u, r);
  return first + second > 0.0 ? first / (first + second) : -1.0;
}

// Of a range of places, first and last + 1: where it is halved, and whether it is a leaf.
uint middleOf(uvec2 range) { return range.x + (range.y - range.x) / 2u; }
bool isEmitterLeaf(uvec2 range) { return range.y - range.x <= kEmittersInLeaf; }

// Sum of the weights in a leaf.
float leafWeight(uvec2 range, Receiver r) {
  float total = 0.0;
  for (uint i = range.x; i < range.y; ++i) total += emitterWeight(emitterAt(i), r);
  return total;
}

// A point on an emissive triangle.
struct EmitterPoint {
  uint triangle;   // kNoTriangle if no emitter faces the receiver
  vec2 weights;    // barycentric, of the triangle's second and third vertex
  vec3 position;   // world space, m
  vec3 normal;     // unit, on the side of the receiver
  vec3 radiance;   // W/(sr m^2)
  float density;   // probability density of the choice, per m^2
};

CONSTANT EmitterPoint kNoEmitterPoint =
    EmitterPoint(kNoTriangle, vec2(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);

// The radiance of a point on an emissive triangle, W/(sr m^2), as far as the surface is seen: not in the holes of alpha
// masks, and with alphaMode BLEND by alpha. weights: barycentric, of the second and third vertex.
vec3 emittedAt(uvec4 triangle, vec2 weights) {
  uint material = materialOf(triangle);
  vec2 uv = uvAt(triangle, weights);
  return materialEmission(material, uv) * coverage(material, uv, alphaAt(triangle, weights));
}

// A piece of an emissive triangle.
struct EmitterPiece {
  Emitter bounds;  // of the piece
  mat3 corners;    // world space, m
  mat3 weights;    // of the corners in the triangle, barycentric
};

// All of a triangle as one piece.
EmitterPiece wholeOf(Emitter e) { return EmitterPiece(e, cornersOf(e.triangle), mat3(1.0)); }

// A point of an emitter, or of a piece of it, on its front. u: uniform in [0, 1).
EmitterPoint pointOn(EmitterPiece piece, vec2 u) {
  float root = sqrt(u.x);
  vec3 inside = vec3(1.0 - root, root * (1.0 - u.y), root * u.y), all = piece.weights * inside;
  vec2 weights = vec2(all.y, all.z);
  Emitter e = piece.bounds;
  return EmitterPoint(e.triangle, weights, piece.corners * inside, e.normal,
                      emittedAt(sceneTriangle(e.triangle), weights), 1.0 / e.area);
}

// A triangle close to the receiver is too large to be aimed at as a whole: at a wall, the light of a long tube that
// hangs before it comes from a short piece of the tube. The walk down the tree goes on into such a triangle, which is
// quartered by lines between the middles of its edges until the piece is small for its distance.
bool isQuartered(Emitter e, Receiver r) {
  vec3 to = r.position - e.centre;
  return dot(to, to) < kFarPiece * e.radius2;
}

// A quarter of a piece. Quarters 0 to 2 lie at its corners, and quarter 3 lies between them. The first function returns
// the bounds of the quarter alone, for which it needs those of the piece and its corners.
Emitter quarterOf(Emitter e, mat3 corners, int number) {
  if (number < 3) e.centre = 0.5 * (e.centre + corners[number]);
  e.power *= 0.25;
  e.area *= 0.25;
  e.radius2 *= 0.25;
  return e;
}
EmitterPiece quarterOf(EmitterPiece piece, int number) {
  EmitterPiece quarter = piece;
  quarter.bounds = quarterOf(piece.bounds, piece.corners, number);
  for (int i = 0; i < 3; ++i) {
    int from = number < 3 ? number : (i + 1) % 3, to = number < 3 ? i : (i + 2) % 3;
    quarter.corners[i] = 0.5 * (piece.corners[from] + piece.corners[to]);
    quarter.weights[i] = 0.5 * (piece.weights[from] + piece.weights[to]);
  }
  return quarter;
}

// The weights of the four quarters of a piece (emitterWeight()).
vec4 quarterWeights(EmitterPiece piece, Receiver r) {
  vec4 weights;
  for (int i = 0; i < 4; ++i) weights[i] = emitterWeight(quarterOf(piece.bounds, piece.corners, i), r);
  return weights;
}

// A random piece of an emitter. choice: as in sampleEmitters(). probability: that of the choice.
EmitterPiece samplePiece(Emitter e, Receiver r, float choice, OUT(float) probability) {
  EmitterPiece piece = wholeOf(e);
  probability = 1.0;
  for (uint i = 0u; i < kMostQuarterings && isQuartered(piece.bounds, r); ++i) {
    vec4 weights = quarterWeights(piece, r);
    float total = dot(weights, vec4(1.0)), left = choice * total;
    if (!(total > 0.0)) break;
    int number = 0;
    while (number < 3 && (left >= weights[number] || weights[number] == 0.0)) left -= weights[number++];
    if (!(weights[number] > 0.0)) break;
    choice = clamp(left / weights[number], 0.0, 1.0 - 1.0 / 16777216.0);
    probability *= weights[number] / total;
    piece = quarterOf(piece, number);
  }
  return piece;
}

// Density with which samplePiece() and pointOn() choose a point of an emitter, per m^2. weights: barycentric, of the
// second and third vertex.
float pieceDensity(Emitter e, Receiver r, vec2 weights) {
  if (!isQuartered(e, r)) return 1.0 / e.area;
  EmitterPiece piece = wholeOf(e);
  vec3 inside = vec3(1.0 - weights.x - weights.y, weights);  // barycentric in the piece
  float probability = 1.0;
  for (uint i = 0u; i < kMostQuarterings && isQuartered(piece.bounds, r); ++i) {
    vec4 its = quarterWeights(piece, r);
    float total = dot(its, vec4(1.0));
    if (!(total > 0.0)) break;
    int number = inside.x > 0.5 ? 0 : inside.y > 0.5 ? 1 : inside.z > 0.5 ? 2 : 3;
    probability *= its[number] / total;
    inside = number == 3 ? 1.0 - 2.0 * inside : 2.0 * inside;
    if (number < 3) inside[number] -= 1.0;
    piece = quarterOf(piece, number);
  }
  return probability / piece.bounds.area;
}

// A random point that may light the receiver; it may be occluded. choice, u: uniform in [0, 1). The choice is rescaled
// after each decision, so that one number is enough.
EmitterPoint sampleEmitters(Receiver r, float choice, vec2 u) {
  EmitterPoint p = kNoEmitterPoint;
  uvec2 range = uvec2(0u, emitterCount());
  float probability = 1.0;
  for (uint node = 1u; !isEmitterLeaf(range);) {
    float first = firstHalf(node, r);
    if (first < 0.0) return p;
    bool second = choice >= first;
    choice = second ? (choice - first) / (1.0 - first) : choice / first;
    probability *= second ? 1.0 - first : first;
    node = 2u * node + uint(second);
    range = second ? uvec2(middleOf(range), range.y) : uvec2(range.x, middleOf(range));
  }
  float total = leafWeight(range, r), reached = 0.0, own = 0.0;
  Emitter chosen;
  for (uint i = range.x; i < range.y && (own == 0.0 || choice * total >= reached); ++i) {
    Emitter e = emitterAt(i);
    float weight = emitterWeight(e, r);
    if (!(weight > 0.0)) continue;
    chosen = e;
    own = weight;
    reached += weight;
  }
  if (!(own > 0.0)) return p;
  float within = clamp((choice * total - reached + own) / own, 0.0, 1.0 - 1.0 / 16777216.0), ofPiece;
  p = pointOn(samplePiece(chosen, r, within, ofPiece), u);
  if (!(dot(chosen.normal, r.position - chosen.centre) > 0.0)) p.normal = -p.normal;
  p.density *= ofPiece * probability * own / total;
  return p;
}

// W / pi, mean of the channels.
float emittersPower(uint node) {
  return uintBitsToFloat(texelOf(rayEmitters, int(emitterHeader().y + 3u * node) + 2).x);
}

// A random emitter, in proportion to its power alone, for which triangles that emit on both sides count twice. At least
// one must have power. choice: as above. probability: that of the choice.
Emitter emitterByPower(float choice, OUT(float) probability) {
  uvec2 range = uvec2(0u, emitterCount());
  probability = 1.0;
  for (uint node = 1u; !isEmitterLeaf(range);) {
    float first = emittersPower(2u * node);
    first /= first + emittersPower(2u * node + 1u);
    bool second = choice >= first;
    choice = second ? (choice - first) / (1.0 - first) : choice / first;
    probability *= second ? 1.0 - first : first;
    node = 2u * node + uint(second);
    range = second ? uvec2(middleOf(range), range.y) : uvec2(range.x, middleOf(range));
  }
  float total = 0.0, reached = 0.0, own = 0.0;
  for (uint i = range.x; i < range.y; ++i) total += powerOfSides(emitterAt(i));
  Emitter chosen = emitterAt(range.x);
  for (uint i = range.x; i < range.y && (own == 0.0 || choice * total >= reached); ++i) {
    Emitter e = emitterAt(i);
    float power = powerOfSides(e);
    if (!(power > 0.0)) continue;
    chosen = e;
    own = power;
    reached += power;
  }
  probability *= total > 0.0 ? own / total : 0.0;
  return chosen;
}

// The place of a triangle in the order of the leaves, or the number of emitters if it is not among them.
uint placeOfEmitter(uint triangle) {
  uint first = 0u, last = emitterCount(), count = last;
  while (first < last) {
    uint middle = first + (last - first) / 2u;
    uvec4 record = texelOf(rayEmitters, int(1u + middle));
    if (record.z == triangle) return record.w;
    if (record.z < triangle) first = middle + 1u;
    else last = middle;
  }
  return count;
}

// Density with which sampleEmitters() chooses a point of a triangle for this receiver, per m^2; 0 if the triangle does
// not emit towards it. weights: barycentric, of the second and third vertex.
float emitterDensity(uint triangle, vec2 weights, Receiver r) {
  uvec2 range = uvec2(0u, emitterCount());
  uint place = placeOfEmitter(triangle);
  if (place >= range.y) return 0.0;
  float probability = 1.0;
  for (uint node = 1u; !isEmitterLeaf(range);) {
    float first = firstHalf(node, r);
    if (first < 0.0) return 0.0;
    bool second = place >= middleOf(range);
    probability *= second ? 1.0 - first : first;
    node = 2u * node + uint(second);
    range = second ? uvec2(middleOf(range), range.y) : uvec2(range.x, middleOf(range));
  }
  Emitter e = emitterAt(place);
  float own = emitterWeight(e, r);
  return own > 0.0 ? probability * own / leafWeight(range, r) * pieceDensity(e, r, weights) : 0.0;
}

// Whether a point is within `reach` metres of a sphere; radius2: its squared radius, m^2.
bool isNear(vec3 point, float reach, vec3 centre, float radius2) {
  float radius = reach + sqrt(radius2);
  return dot(point - centre, point - centre) <= radius * radius;
}

// Whether an emissive triangle is within `reach` metres of a point, by the bounding spheres of triangles.
bool isEmitterWithin(vec3 point, float reach) {
  if (emitterCount() == 0u) return false;
  const uint kDeepest = 32u;
  uvec3 stack[kDeepest];  // node, and the range of its emitters
  stack[0] = uvec3(1u, 0u, emitterCount());
  for (uint size = 1u; size > 0u;) {
    uvec3 top = stack[--size];
    uvec2 range = uvec2(top.y, top.z);
    vec4 sphere = uintBitsToFloat(texelOf(rayEmitters, int(emitterHeader().y + 3u * top.x)));
    // The bounding sphere of a triangle may extend beyond that of its node, but no farther than this.
    if (!isNear(point, reach, vec3(sphere), 9.0 * sphere.w)) continue;
    if (isEmitterLeaf(range)) {
      for (uint i = range.x; i < range.y; ++i) {
        Emitter e = emitterAt(i);
        if (isNear(point, reach, e.centre, e.radius2)) return true;
      }
    } else {
      stack[size++] = uvec3(2u * top.x, range.x, middleOf(range));
      stack[size++] = uvec3(2u * top.x + 1u, middleOf(range), range.y);
    }
  }
  return false;
}

// ---- The environment map -------------------------------------------------------------------------------------------

// The map's cumulative light. mapValue() is value i of the table, and mapShare() the share of element i of the row of
// values that starts at `first`. The values of rows of texels follow those of the texels, from firstMapRow() on.
float mapValue(uint i) {
  return uintBitsToFloat(texelOf(rayEmitters, int(emitterHeader().z + i / 4u))[i & 3u]);
}
float mapShare(uint first, uint i) { return mapValue(first + i) - (i > 0u ? mapValue(first + i - 1u) : 0.0); }
uint firstMapRow() {
  ivec2 size = environmentSize();
  return uint(size.x * size.y);
}
bool isMapBlack() { return !(mapValue(firstMapRow() + uint(environmentSize().y) - 1u) > 0.0); }

// The first of `count` cumulative values from `first` on that exceeds u. within: how far u lies between it and the one
// before, in [0, 1).
uint chooseInMap(uint first, uint count, float u, OUT(float) within) {
  uint low = 0u, high = count - 1u;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (mapValue(first + middle) > u) high = middle;
    else low = middle + 1u;
  }
  float before = low > 0u ? mapValue(first + low - 1u) : 0.0;
  within = clamp((u - before) / (mapValue(first + low) - before), 0.0, 1.0 - 1.0 / 16777216.0);
  return low;
}

// The probability density of directions in a texel of the map, per sr.
float mapDensityIn(uvec2 texel) {
  uvec2 size = uvec2(environmentSize());
  float step_ = kPi / float(size.y);
  float solidAngle = 2.0 * kPi / float(size.x) * 2.0 * sin(0.5 * step_) * sin((float(texel.y) + 0.5) * step_);
  return mapShare(texel.y * size.x, texel.x) * mapShare(firstMapRow(), texel.y) / solidAngle;
}

// The probability density with which sampleMap() chooses a direction, which is unit, per sr.
float mapDensity(vec3 direction) {
  vec2 size = vec2(environmentSize());
  float around = (atan(direction.x, -direction.z) + frame.environmentTurn) / (2.0 * kPi) + 0.5;
  vec2 place = vec2(fract(around), acos(clamp(direction.y, -1.0, 1.0)) / kPi) * size;
  return mapDensityIn(uvec2(min(place, size - 1.0)));
}

// A direction to the map.
struct MapSample {
  vec3 direction, radiance;  // unit; W/(sr m^2)
  float density;  // per sr; 0: the map is black
};

// A random direction, in proportion to the light from each texel of the map. u: uniform in [0, 1).
MapSample sampleMap(vec2 u) {
  if (isMapBlack()) return MapSample(vec3(0.0), vec3(0.0), 0.0);
  uvec2 size = uvec2(environmentSize());
  vec2 within;
  uint row = chooseInMap(firstMapRow(), size.y, u.y, within.y);
  uint column = chooseInMap(row * size.x, size.x, u.x, within.x);
  float step_ = kPi / float(size.y);
  float y = mix(cos(float(row) * step_), cos(float(row + 1u) * step_), within.y);  // uniform in the texel's solid angle
  float around = ((float(column) + within.x) / float(size.x) - 0.5) * 2.0 * kPi - frame.environmentTurn;
  float across = sqrt(max(1.0 - y * y, 0.0));
  vec3 direction = vec3(across * sin(around), y, -across * cos(around));
  return MapSample(direction, environmentRadiance(direction), mapDensityIn(uvec2(column, row)));
}

#endif
