#include "passes/near-field-host/near_field_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/base/weighted_choice.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/fovea.h"
#include "passes/near-field-host/cached_light.h"
#include "passes/near-field-host/receiver_lobe.h"
#include "passes/same_plane.h"
#include "shaders/records/near_field.h"
#include "shaders/records/rays.h"

namespace fovea::passes {
namespace {

using namespace scene;

// What one row of the picture, or one part of a list, adds.
struct Row : GatheredLight {
  uint64_t shaded = 0;
  double hits = 0, length = 0;
};

// What the eye sees at a pixel.
struct Seen {
  TracedSurface surface;
  ReceiverLobe lobe;
};

// Light that arrives: irradiance / pi, and the mean under the lobe of the surface.
struct NearLight {
  glm::vec3 light{0}, gloss{0};

  void add(const Seen& to, glm::vec3 its, glm::vec3 direction) {
    light += its;
    gloss += to.lobe.response(direction, glm::dot(to.surface.normal, direction)) * its;
  }
  NearLight& operator+=(const NearLight& other) {
    light += other.light;
    gloss += other.gloss;
    return *this;
  }
};

// A sample of a block of pixels. code: sampleCode().
struct Sample : NearLight {
  float code = 0;
};

// The sample of `spacing` x `spacing` pixels outside the fovea, and where it was taken.
struct Tile {
  Sample sample;
  TracedSurface at;
  bool narrow = false;  // whether it is divided into blocks of 2 x 2 pixels
};

class Tracer {
 public:
  Tracer(const Frame& frame, const View& view, const RayScene& rays, const NearFieldSettings& settings,
         std::span<glm::vec4> image, std::span<glm::vec4> gloss)
      : view_(view),
        settings_(settings),
        surfaces_(frame, view, rays, settings.fullMaterials),
        image_(image),
        gloss_(gloss),
        columns_((view.size.x + 1) / 2),
        rows_((view.size.y + 1) / 2),
        fovea_(makeFovea(view.gaze, glm::vec2(view.size), settings.foveaRadius)),
        tiles_(image.empty() ? 0 : size_t(tileColumns()) * tileRows()) {}

  uint32_t tileColumns() const { return (view_.size.x + settings_.spacing - 1) / settings_.spacing; }
  uint32_t tileRows() const { return (view_.size.y + settings_.spacing - 1) / settings_.spacing; }

  // Traces all tiles of `spacing` pixels in one row.
  void traceTiles(uint32_t row, Row& statistics) {
    const uint32_t spacing = settings_.spacing;
    for (uint32_t column = 0; column < tileColumns(); ++column) {
      const glm::uvec2 corner = spacing * glm::uvec2(column, row);
      const glm::vec2 nearest =
          glm::clamp(fovea_.centre, glm::vec2(corner), glm::vec2(corner) + float(spacing));
      Tile& tile = tiles_[row * tileColumns() + column];
      tile.narrow =
          glm::distance(nearest, fovea_.centre) <= fovea_.radius || isCloseToEmitter(corner, statistics);
      if (!tile.narrow) {
        tile.sample = sampleOf(corner, spacing, tile.at, statistics);
      } else {
        forTexels({column, row}, [&](glm::uvec2 texel) {
          TracedSurface at;
          write(texel, sampleOf(2u * texel, 2, at, statistics));
        });
      }
    }
  }

  // Gives the wide tiles of one row the mean of the 3 x 3 tiles around them, as far as they lie on the same
  // surface. A ray is a poor estimate, and one that hits something bright would be seen as a spot for many frames.
  void spreadTiles(uint32_t row) {
    for (uint32_t column = 0; column < tileColumns(); ++column) {
      const Tile& tile = tiles_[row * tileColumns() + column];
      if (tile.narrow) continue;
      const Sample shared{tile.at.there ? meanAround(int(column), int(row)) : NearLight{}, tile.sample.code};
      forTexels({column, row}, [&](glm::uvec2 texel) { write(texel, shared); });
    }
  }

  glm::vec4 pixelLight(glm::uvec2 pixel, Row& statistics) const {
    const Seen seen = look(pixel, statistics);
    if (!seen.surface.there) return glm::vec4(0);
    NearLight sum;
    for (uint32_t turn = settings_.turn; turn < settings_.turn + settings_.samples; ++turn)
      sum += lightAt(seen, pixel, turn, statistics);
    return {sum.light / float(std::max(settings_.samples, 1u)), 1};
  }

 private:
  template <class Function>
  void forTexels(glm::uvec2 tile, const Function& function) const {
    const uint32_t step = settings_.spacing / 2;
    for (uint32_t i = 0; i < step * step; ++i) {
      const glm::uvec2 texel = step * tile + glm::uvec2(i % step, i / step);
      if (texel.x < columns_ && texel.y < rows_) function(texel);
    }
  }

  void write(glm::uvec2 texel, const Sample& sample) {
    const size_t place = size_t(texel.y) * columns_ + texel.x;
    image_[place] = {sample.light, sample.code};
    if (!gloss_.empty()) gloss_[place] = {sample.gloss, sample.code};
  }

  Seen look(glm::uvec2 pixel, Row& statistics) const {
    Seen seen{surfaces_.look(glm::vec2(pixel) + 0.5f, statistics.rays), {}};
    if (settings_.normal.empty() || !seen.surface.there) return seen;
    const size_t place = size_t(pixel.y) * view_.size.x + pixel.x;
    seen.lobe = ReceiverLobe(glm::unpackHalf4x16(settings_.normal[place]),
                             glm::unpackHalf4x16(settings_.specular[place]),
                             glm::normalize(view_.eye - seen.surface.position));
    return seen;
  }

  // Whether a lamp is so close that its light differs within a wide block, by what the pixel in its middle shows.
  bool isCloseToEmitter(glm::uvec2 corner, Row& statistics) const {
    if (settings_.mapAlone || surfaces_.emitters().empty()) return false;
    const glm::vec2 middle =
        glm::min(glm::vec2(corner) + 0.5f * float(settings_.spacing), glm::vec2(view_.size) - 0.5f);
    const TracedSurface v = surfaces_.look(middle, statistics.rays);
    if (!v.there || surfaces_.emitted(v) != glm::vec3(0)) return false;
    const glm::vec3 across = view_.rayDirection(middle + glm::vec2(1, 0)), along = view_.rayDirection(middle);
    const float width = float(settings_.spacing) *
                        glm::distance(glm::normalize(across), glm::normalize(along)) *
                        glm::distance(v.position, view_.eye);
    return surfaces_.emitters().within(v.position, kClose * width);
  }

  // Wider or flatter weights would make what has just come into view flicker more, as its brightest sample is dropped.
  NearLight meanAround(int column, int row) const {
    static constexpr float kWeights[] = {1, kTileMiddleWeight, 1};
    const TracedSurface& at = tiles_[size_t(row) * tileColumns() + size_t(column)].at;
    NearLight sum;
    float weights = 0;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, int(tileRows()) - 1); ++y)
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, int(tileColumns()) - 1); ++x) {
        const Tile& other = tiles_[size_t(y) * tileColumns() + size_t(x)];
        if (other.narrow || !sameSurface(at, other.at)) continue;
        const float weight = kWeights[x - column + 1] * kWeights[y - row + 1];
        sum.light += weight * other.sample.light;
        sum.gloss += weight * other.sample.gloss;
        weights += weight;
      }
    return {sum.light / weights, sum.gloss / weights};
  }
  static bool sameSurface(const TracedSurface& a, const TracedSurface& b) {
    return b.there && onSamePlane(a.position, a.normal, b.position, b.normal);
  }

  // Returns the mean over the turns. `at` becomes the surface of the first turn's pixel, from which rays also leave in
  // those turns whose pixel shows another surface.
  Sample sampleOf(glm::uvec2 corner, uint32_t side, TracedSurface& at, Row& statistics) const {
    const glm::uvec2 block = corner / side;
    const uint32_t factor = side == 2 ? settings_.foveaFactor : 1, count = factor * settings_.samples;
    const auto seenIn = [&](uint32_t turn) {
      const glm::uvec2 pixel = corner + samplePixel(turn, side, block);
      const bool inside = pixel.x < view_.size.x && pixel.y < view_.size.y;
      return inside ? look(pixel, statistics) : Seen{};
    };
    const Seen first = seenIn(settings_.turn);
    at = first.surface;
    NearLight sum;
    for (uint32_t i = 0; at.there && i < count; ++i) {
      const Seen seen = i < factor ? first : seenIn(settings_.turn + i / factor);
      sum += lightAt(sameSurface(at, seen.surface) ? seen : first, block, factor * settings_.turn + i,
                     statistics);
    }
    const uint32_t code = sampleCode(side, samplePixel(settings_.turn, side, block), at.there);
    return {{sum.light / float(count), sum.gloss / float(count)}, float(code)};
  }

  // Adjacent blocks, 4 x 4 of them, take turns in one sequence.
  NearLight lightAt(const Seen& to, glm::uvec2 block, uint32_t turn, Row& statistics) const {
    const TracedSurface& v = to.surface;
    const glm::uvec2 group = block / 4u, place = block % 4u;
    const uint32_t order = (place.x & 1u) << 3 | (place.y & 1u) << 2 | (place.x & 2u) | place.y >> 1;
    const uint32_t stream = randomStream(settings_.seed, group.x, kNearStream, group.y);
    const glm::vec3 direction = cosineDirection(v.normal, streamSequence(stream, 16 * turn + order));
    // Rays are traced only as far as they contribute: beyond that, a hit is worth no more than a miss.
    const float radius2 = settings_.area * glm::one_over_pi<float>();
    const float choice = std::max(uniformFloat(randomStream(stream, turn, kChoiceStream, order)), 1e-6f);
    const float reach = radius2 > 0 ? std::sqrt(radius2 * (kSure / choice - 1)) : kFarAway;
    NearLight light;
    if (surfaces_.hasEmitters() && radius2 > 0)
      addEmitters(light, to, hashCombine(stream, kNearAimStream), 16 * turn + order, statistics);
    if (glm::dot(direction, v.face) <= 0) return light;
    const bool tracesOutside = surfaces_.hasEnvironment() && radius2 > 0;
    const TracedSurface hit =
        surfaces_.arrive(v.origin, direction, tracesOutside ? kFarAway : reach, statistics.rays);
    if (tracesOutside && hit.isOutside()) {
      light.add(to, hit.brighter * sharedLight(v, surfaces_.towardsOutside(v, direction)), direction);
      return light;
    }
    if (!hit.there || settings_.mapAlone) return light;
    const float distance = glm::distance(hit.position, v.position);
    if (tracesOutside && distance > reach) return light;
    const float probability = radius2 > 0 ? probabilityAt(distance) : 1.0f;
    statistics.hits += 1 / probability;
    statistics.length += distance / probability;
    if (!(radius2 > 0)) return light;
    ++statistics.shaded;
    const glm::vec3 rho = surfaces_.reflectance(hit);
    glm::vec3 radiance = surfaces_.directTowards(hit, -direction, rho, kBounceRoughness, statistics.rays);
    radiance += rho * gatheredLight(surfaces_, hit, settings_.bounces - 1,
                                    randomStream(stream, turn, kNearGatherStream, order), settings_.cache,
                                    settings_.cellWidth, statistics);
    if (const glm::vec3 emitted = surfaces_.emitted(hit); emitted != glm::vec3(0)) {
      const float cosine = cosineDensity(v, direction);
      const float points = float(settings_.emitterPoints);
      light.add(to, emitted * (cosine / (cosine * probability + points * surfaces_.emitterDensity(v, hit))),
                direction);
    }
    light.add(to, radiance * (partAt(distance) / probability), direction);
    return light;
  }

  // The part of a ray aimed at emissive surfaces, in the balance heuristic beside the cosine-weighted one, which may
  // hit them by chance. The ray goes to one of several points, chosen by the light that they send if nothing hides them
  // (Talbot et al., "Importance Resampling for Global Illumination", EGSR 2005). The points share out the emitters, and
  // those of consecutive samples follow low-discrepancy sequences. For the environment there are as many
  // cosine-weighted points beside them.
  void addEmitters(NearLight& sum, const Seen& to, uint32_t stream, uint32_t index, Row& statistics) const {
    const TracedSurface& v = to.surface;
    const uint32_t points = settings_.emitterPoints;
    const float place = uniformFloat(hashCombine(stream, 0) + index * kGoldenRatio);
    WeightedChoice choice(uniformFloat(hashCombine(stream, 1) + index * kSilverRatio));
    SurfaceTracer::EmitterRay chosen;
    glm::vec3 light(0);
    const auto consider = [&](const SurfaceTracer::EmitterRay& ray) {
      if (!ray.there || (settings_.mapAlone && ray.triangle != kNoIndex)) return;
      const glm::vec3 its = sharedLight(v, ray) / float(points);
      const float part = its.r + its.g + its.b;
      if (!(part > 0) || !choice.takes(part)) return;
      chosen = ray;
      light = its;
    };
    const auto pointOf = [&](uint32_t i) { return streamSequence(hashCombine(stream, i + 2), index); };
    for (uint32_t i = 0; i < points; ++i) {
      const glm::vec2 u = pointOf(i);
      consider(surfaces_.towardsEmitter(v, {(float(i) + place) / float(points), u.x, u.y}));
    }
    for (uint32_t i = points; surfaces_.hasEnvironment() && i < 2 * points; ++i)
      consider(surfaces_.towardsOutside(v, cosineDirection(v.normal, pointOf(i))));
    if (!choice.any()) return;
    sum.add(to, light * surfaces_.visibility(v, chosen, statistics.rays) * choice.inverseProbability(),
            chosen.direction);
  }

  // The light along a ray over the densities of all ways to choose it, as far as each counts. Beside the points on
  // surfaces a cosine-weighted ray counts once. In the environment it counts as much as all cosine-weighted points
  // together: most noise comes from what hides the sky, and two rays find out more about that than one.
  glm::vec3 sharedLight(const TracedSurface& v, const SurfaceTracer::EmitterRay& to) const {
    if (!to.there) return glm::vec3(0);
    const float cosine = cosineDensity(v, to.direction);
    const float cosineWeighted =
        to.triangle == kNoIndex ? 2 : probabilityAt(to.distance) / float(settings_.emitterPoints);
    return to.radiance * (cosine / (cosine * cosineWeighted + to.density));
  }

  // The part of the light from this distance that discs leave out, and the probability with which a cosine-weighted
  // ray goes so far.
  float partAt(float distance) const {
    const float radius2 = settings_.area * glm::one_over_pi<float>();
    return radius2 / (distance * distance + radius2);
  }
  float probabilityAt(float distance) const { return std::min(kSure * partAt(distance), 1.0f); }

  static float cosineDensity(const TracedSurface& v, glm::vec3 direction) {
    return glm::dot(v.normal, direction) * glm::one_over_pi<float>();
  }

  const View& view_;
  const NearFieldSettings& settings_;
  SurfaceTracer surfaces_;
  std::span<glm::vec4> image_, gloss_;
  uint32_t columns_, rows_;
  Fovea fovea_;
  std::vector<Tile> tiles_;
};

// Calls trace(row, sums) for all rows, on several threads, fills the cache and returns the sum of the statistics.
template <class Trace>
NearFieldStatistics traceRows(uint32_t count, const NearFieldSettings& settings, const Trace& trace) {
  std::vector<Row> rows(count);
  std::atomic<uint32_t> next = 0;
  onThreads(std::min(threadCount(settings.threads), count), [&] {
    for (uint32_t row = next++; row < count; row = next++) trace(row, rows[row]);
  });
  NearFieldStatistics sum;  // summed in a fixed order
  for (const Row& row : rows) {
    sum.rays += row.rays;
    sum.shaded += row.shaded;
    sum.gathered += row.gathered;
    sum.hits += row.hits;
    sum.length += row.length;
    if (settings.cache) settings.cache->add(row.samples);
  }
  return sum;
}

}  // namespace

glm::uvec2 samplePixel(uint32_t turn, uint32_t side, glm::uvec2 block) {
  turn += ((block.x & 1u) * 2u) ^ ((block.y & 1u) * 3u);
  glm::uvec2 p(0);
  for (uint32_t bit = side / 2; bit > 0; bit /= 2, turn /= 4) {
    p.x += (turn & 1u) * bit;
    p.y += ((turn ^ turn >> 1) & 1u) * bit;
  }
  return p;
}

NearFieldStatistics traceNearField(const Frame& frame, const View& view, const RayScene& rays,
                                   const NearFieldSettings& settings, std::span<glm::vec4> image,
                                   std::span<glm::vec4> gloss) {
  Tracer tracer(frame, view, rays, settings, image, gloss);
  const NearFieldStatistics statistics =
      traceRows(tracer.tileRows(), settings, [&](uint32_t row, Row& sum) { tracer.traceTiles(row, sum); });
  traceRows(tracer.tileRows(), settings, [&](uint32_t row, Row&) { tracer.spreadTiles(row); });
  return statistics;
}

NearFieldStatistics traceNearFieldPixels(const Frame& frame, const View& view, const RayScene& rays,
                                         const NearFieldSettings& settings,
                                         std::span<const glm::uvec2> pixels, std::span<glm::vec4> light) {
  constexpr size_t kChunk = 256;
  const Tracer tracer(frame, view, rays, settings, {}, {});
  return traceRows(uint32_t((pixels.size() + kChunk - 1) / kChunk), settings, [&](uint32_t row, Row& sum) {
    const size_t end = std::min((row + 1) * kChunk, pixels.size());
    for (size_t i = row * kChunk; i < end; ++i) light[i] = tracer.pixelLight(pixels[i], sum);
  });
}

}  // namespace fovea::passes
