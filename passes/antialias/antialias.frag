// Temporal antialiasing (Karis, "High-Quality Temporal Supersampling", SIGGRAPH 2014). The view is jittered, so that a
// mean over frames is one over the area of a pixel. It follows the surfaces; whatever has changed otherwise shows where
// the mean lies outside the colours around the pixel, to which it is clipped (Salvi, "An Excursion in Temporal
// Supersampling", GDC 2016).
//
// Where surfaces let light through, a pixel shows now this one and now that (shaders/materials/passage.glsl).
// The mean of all is what the eye should see, so it is one of light as it is; the box is that of more pixels, which
// show each surface by its share; and the mean follows the surface that the pixel shows, as there is no telling which
// is the nearest. With ONLY_VEILS 1 nothing else is smoothed.
#include "device/finite.glsl"
#include "materials/gloss.glsl"
#include "scene/motion.glsl"
#include "screen/pixel_ray.glsl"

// Images rather than textures, which cost several times as much on a CPU device.
layout(rgba16f) uniform readonly image2D radiance;
SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(r32ui) uniform readonly uimage2D gbufferId;
layout(r32ui) uniform readonly uimage2D gbufferTriangle;
SURFACES(previous, previousAt)
layout(r32ui) uniform readonly uimage2D previousId;
layout(r32ui) uniform readonly uimage2D origin;
layout(rgba16f) uniform readonly image2D history;
layout(location = 0) out vec4 smoothed;
layout(std430) buffer Counters { uint value[]; } counters;

layout(push_constant) uniform Constants {
  float frames;      // length of the mean
  float deviations;  // half the width of the box to which it is clipped
};

const uint kNone = 0xffffffffu;
const float kSamePlace = 1e-3;  // pixels: does not move
const float kNear = 3.5;        // pixels: as far as surfaces in the 3x3 pixels of two frames may be apart
const float kMaxHalf = 65504.0;
const float kVeiledFrames = 2.0;  // by how much the mean is longer where surfaces let light through
const float kVeiledStart = 8.0;   // frames that the pixels around one are worth there in its first frame

float luminanceOf(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

// Means are formed of compressed light, as Karis does: a pixel half covered by something far brighter than the display
// would otherwise be as white as that, and its edge as jagged as before. strength: 1, or 0 for light as it is.
vec3 compress(vec3 light, float strength) {
  light *= frame.exposure;
  return light / (1.0 + strength * luminanceOf(light));
}
vec3 expand(vec3 light, float strength) {
  return light / (max(1.0 - strength * luminanceOf(light), 1e-6) * frame.exposure);
}

// Y, Co and Cg, in which the colours around a pixel fill a box better than in red, green and blue.
vec3 toYCoCg(vec3 c) {
  return vec3(dot(c, vec3(0.25, 0.5, 0.25)), 0.5 * (c.r - c.b), dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 fromYCoCg(vec3 c) { return vec3(c.x - c.z + c.y, c.x + c.z, c.x - c.z - c.y); }

vec3 finiteLight(ivec2 p) {
  vec3 light = imageLoad(radiance, p).rgb;
  return finite(vec4(light, 0.0)) ? light : vec3(0.0);
}

// What the 3x3 pixels around a pixel show, or the 5x5 where surfaces let light through.
struct Around {
  int count;             // number of those pixels
  vec3 mean, deviation;  // of the compressed light, YCoCg
  ivec2 nearest;         // the pixel with the surface nearest to the eye
  vec4 position;         // of that surface; w: 0 if there is only background
  bool seenBefore;       // whether the previous frame showed any of it
  uint id[25];           // of the G-buffer
};

Around around(ivec2 p, ivec2 size, bool veiled) {
  Around a;
  int side = veiled ? 5 : 3;
  a.count = side * side;
  a.mean = a.deviation = vec3(0.0);
  a.nearest = p;
  a.position = vec4(0.0);
  a.seenBefore = false;
  for (int i = 0; i < a.count; ++i) {
    ivec2 q = clamp(p + ivec2(i % side, i / side) - side / 2, ivec2(0), size - 1);
    vec3 colour = toYCoCg(compress(finiteLight(q), veiled ? 0.0 : 1.0));
    a.mean += colour;
    a.deviation += colour * colour;
    vec4 position = surfaceAt(q);
    bool surface = position.w > 0.0, nearer = surface && (a.position.w == 0.0 || position.w < a.position.w);
    a.nearest = nearer ? q : a.nearest;
    a.position = nearer ? position : a.position;
    a.id[i] = imageLoad(gbufferId, q).r;
    a.seenBefore = a.seenBefore || !surface || imageLoad(origin, q).r != kNone;
  }
  a.mean /= float(a.count);
  a.deviation = sqrt(max(a.deviation / float(a.count) - a.mean * a.mean, 0.0));
  if (veiled) {
    a.nearest = p;
    a.position = surfaceAt(p);
  }
  return a;
}

// Where the picture of this pixel was in the previous frame, z: 0 if it was behind the eye. An edge moves with what is
// nearer, so all pixels beside it do (Karis). The jitter moves what is seen, but not the picture.
vec3 placeBefore(ivec2 p, Around a, vec2 size) {
  bool surface = a.position.w > 0.0;
  uint id = imageLoad(gbufferId, a.nearest).r, triangle = imageLoad(gbufferTriangle, a.nearest).r;
  Motion motion = motionOf(a.position.xyz, surface ? id : 0u, triangle);
  vec4 point = surface ? vec4(pointBefore(motion, a.position.xyz), 1.0) : vec4(pixelRay(p), 0.0);
  vec4 clip = view.previousWorldToClip * point;
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * size - 0.5 - view.jitterStep;  // texel centres at whole numbers
  at += vec2(surface ? p - a.nearest : ivec2(0));
  return vec3(mix(at, vec2(p), lessThan(abs(at - vec2(p)), vec2(kSamePlace))), float(clip.w > 0.0));
}

// Whether a surface that the previous frame showed near this pixel can still be near it: an object that does not move,
// at a place that the view still shows there. Background can.
bool canBeHere(uint id, vec4 position, ivec2 p, vec2 size) {
  uint object = id >> 16;
  bool still = object == 0u || (objectVisible(object) && !objectDeforms(object) &&
                                objectTransform(object) == previousObjectTransform(object));
  vec4 clip = view.worldToClip * vec4(position.xyz, 1.0);
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * size - 0.5 + view.jitterStep;
  bool near = clip.w > 0.0 && all(lessThan(abs(at - vec2(p)), vec2(kNear)));
  return !(position.w > 0.0) || (still && near);
}

// Whether the history of a place shows something that has left since: one of the 3x3 pixels around it showed a surface
// that none of those around this pixel shows, and it is not merely too thin for the jitter to meet in every frame.
// Clipping alone would leave a trail where the colours around the pixel differ much.
bool hasLeft(ivec2 p, ivec2 from, Around a, ivec2 size) {
  bool left = false;
  for (int i = 0; i < 9; ++i) {
    ivec2 q = clamp(from + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1);
    uint id = imageLoad(previousId, q).r;
    bool here = false;
    for (int k = 0; k < a.count; ++k) here = here || a.id[k] == id;
    if (!here) left = left || !canBeHere(id, previousAt(q), p, vec2(size));
  }
  return left;
}

// Weights of four texels in a row, of which the place lies `t` after the second (Catmull and Rom 1974).
vec4 catmullRom(float t) {
  return 0.5 * vec4(((2.0 - t) * t - 1.0) * t, (3.0 * t - 5.0) * t * t + 2.0, ((4.0 - 3.0 * t) * t + 1.0) * t,
                    (t - 1.0) * t * t);
}

// rgb: compressed light of the history, a: number of frames in it. Bilinear filtering would blur more in each frame;
// Catmull and Rom's cubic keeps what moves sharp (Jimenez, "Filmic SMAA", SIGGRAPH 2016).
vec4 historyAt(vec2 at, ivec2 p, ivec2 size, float strength) {
  vec2 corner = floor(at);
  vec4 x = catmullRom(at.x - corner.x), y = catmullRom(at.y - corner.y);
  int moved = int(at != vec2(p));  // only then is more than the texel itself needed, which is number 5
  vec3 sum = vec3(0.0);
  for (int i = 5 - 5 * moved; i < 6 + 10 * moved; ++i) {
    ivec2 q = clamp(ivec2(corner) + ivec2(i & 3, i >> 2) - 1, ivec2(0), size - 1);
    sum += x[i & 3] * y[i >> 2] * compress(imageLoad(history, q).rgb, strength);
  }
  return vec4(sum, imageLoad(history, clamp(ivec2(round(at)), ivec2(0), size - 1)).a);
}

// The mean of the 5x5 pixels around one at which something lets light through: together they show each surface by its
// share.
vec3 veiledMean(ivec2 p, ivec2 size, bool wanted) {
  vec4 sum = vec4(0.0);
  for (int i = 0; i < (wanted ? 25 : 0); ++i) {
    ivec2 q = clamp(p + ivec2(i % 5, i / 5) - 2, ivec2(0), size - 1);
    if (isVeiled(imageLoad(gbufferNormal, q).a)) sum += vec4(finiteLight(q), 1.0);
  }
  return sum.rgb / max(sum.a, 1.0);
}

// Draws a colour towards the middle of a box until it lies inside.
vec3 clipped(vec3 colour, vec3 middle, vec3 extent) {
  vec3 away = colour - middle, ratio = abs(away) / max(extent, 1e-5);
  return middle + away / max(max(max(ratio.x, ratio.y), ratio.z), 1.0);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = imageSize(radiance);
  if (!finite(vec4(imageLoad(radiance, p).rgb, 0.0))) atomicAdd(counters.value[0], 1u);
  vec3 light = finiteLight(p);
  bool veiled = isVeiled(imageLoad(gbufferNormal, p).a);
  float strength = veiled ? 0.0 : 1.0;
  Around a = around(p, size, veiled);
  vec3 at = placeBefore(p, a, vec2(size));
  bool inside = at.z > 0.0 && all(greaterThanEqual(at.xy, vec2(-0.5))) && all(lessThan(at.xy, vec2(size) - 0.5));
  vec4 old = historyAt(inside ? at.xy : vec2(p), p, size, strength);
  bool known = inside && a.seenBefore && !hasLeft(p, ivec2(round(at.xy)), a, size);
  float count = known ? min(old.a, frames * (veiled ? kVeiledFrames : 1.0) - 1.0) : 0.0;
  vec3 kept = fromYCoCg(clipped(toYCoCg(old.rgb), a.mean, deviations * a.deviation));
  vec3 mean = expand(mix(kept, compress(light, strength), 1.0 / (count + 1.0)), strength);
#if ONLY_VEILS
  if (!veiled || old.a < kVeiledStart) count = 0.0;  // fewer: nothing let light through there before
#endif
  bool begins = veiled && count == 0.0;
  vec3 first = veiledMean(p, size, begins);
  smoothed = begins ? vec4(first, kVeiledStart)
                    : vec4(count > 0.0 ? clamp(mean, 0.0, kMaxHalf) : light, count + 1.0);
}
