// Judges the light in the first camera's picture by a few rays, adds some where it is dark, and sets the exposure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <vector>

#include "fovea/image.h"
#include "framework/scene/environment/sky.h"
#include "framework/scene/first_view/first_view.h"
#include "framework/scene/first_view/light_meter.h"
#include "framework/scene/floor.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kWidth = 48;          // of the picture, pixels
constexpr float kDark = 0.02f;           // of the brightest light: less is not visible beside it
constexpr float kDarkFloor = 0.1f;       // the same of a floor beside what lights itself
constexpr float kFaint = 0.005f;         // of what emissive surfaces emit: less than lamps give
constexpr float kSeen = 0.5f;            // of the surfaces: the share that light has to reach
constexpr float kSeenByLamps = 0.1f;     // the same if the model has lights: the rest may be meant to be dark
constexpr float kDisplay = 0.45f;        // mean display value
constexpr float kClipped = 0.015f;       // most of the surfaces' pixels that may be clipped
constexpr float kDisplayInDark = 0.27f;  // the same where most of the picture stays dark with that,
constexpr float kClippedInDark = 0.04f;  // and more may be clipped
constexpr float kLamplight = 3.0f;       // lux, at the median distance
const glm::vec3 kBackground(0.22f, 0.33f, 0.5f);  // where there is no sky, as displayed before sRGB

using Picture = std::vector<MeterPoint>;

const LightMeter* meter = nullptr;

Frame firstFrame(const Scene& scene, const Geometry& geometry) {
  return makeFrame(scene, geometry, {kWidth, kWidth}, 0, 1);
}

float brightest(glm::vec3 light) { return std::max({light.r, light.g, light.b}); }

// The picture without the floor that was added, and that floor alone.
struct Parts {
  Picture things, floor;
};

Parts partsOf(const Scene& scene, const Geometry& geometry, const Picture& picture, bool floorAdded) {
  if (!floorAdded) return {picture, {}};
  const float above = 1e-5f * glm::length(geometry.boundsMax - geometry.boundsMin),
              height = scene.nodes.back().translation.y + above;
  Parts parts;
  for (const MeterPoint& point : picture)
    (point.position.y <= height ? parts.floor : parts.things).push_back(point);
  return parts;
}

// Radiance of the surfaces in a picture, ascending.
std::vector<float> radianceOf(const Picture& picture) {
  std::vector<float> list;
  for (const MeterPoint& point : picture)
    if (point.there > 0) list.push_back(brightest(point.radiance));
  std::ranges::sort(list);
  return list;
}

// How bright the median of the floor is, relative to the brightest in the picture; 1 if it shows no floor.
float floorBrightness(const Picture& picture, const Picture& floor) {
  const std::vector<float> all = radianceOf(picture), ground = radianceOf(floor);
  if (ground.empty()) return 1;
  const float bright = all[size_t(float(all.size()) * (1 - kClipped))];
  return bright > 0 ? ground[ground.size() / 2] / bright : 0;
}

// What emits in the scene and nothing else lights: the mean radiance of emissive surfaces, weighted by their power, at
// most 1, which a screen without an exposure shows as white. 0 where there are lights or an environment.
float glow(const Scene& scene, const Geometry& geometry) {
  if (!scene.lights.empty() || scene.environmentMap || scene.environment != glm::vec3(0)) return 0;
  double power = 0, weighted = 0;
  for (const uint32_t t : geometry.emissive) {
    const Triangle& triangle = geometry.triangles[t];
    const Material& material = scene.materials[triangle.material()];
    if (material.unlit) continue;
    const glm::vec3 a = geometry.positions[triangle.v[0]], b = geometry.positions[triangle.v[1]],
                    c = geometry.positions[triangle.v[2]];
    const double radiance = double(brightest(material.emission));
    const double own = radiance * double(glm::length(glm::cross(b - a, c - a)));
    power += own;
    weighted += own * radiance;
  }
  return power > 0 ? float(std::min(weighted / power, 1.0)) : 0;
}

// Whether most of what a picture shows is emissive or unlit.
bool mostLightsItself(const Picture& picture) {
  uint32_t own = 0, others = 0;
  for (const MeterPoint& point : picture)
    if (point.there > 0) ++(point.emitted > 0 ? own : others);
  return own > others;
}

// Whether enough light reaches at least this share of the surfaces that they can be seen beside the brightest. Emissive
// surfaces are seen in any case, and are no measure for others, as a lamp is always far brighter than the room that it
// lights. If nothing but such surfaces gives light, however, `glow` is a measure as well: one that emits no more than a
// white pixel and hardly lights its surroundings is a screen or a glowing sign, and no lamp.
bool isLit(const Picture& picture, float share, float glow) {
  std::vector<float> visible, lit;
  for (const MeterPoint& point : picture) {
    if (!(point.there > 0)) continue;
    visible.push_back(std::max(point.arriving, point.emitted));
    if (!(point.emitted > 0)) lit.push_back(point.arriving);
  }
  if (visible.empty()) return true;
  std::ranges::sort(visible);
  std::ranges::sort(lit);
  const float bright = lit.empty() ? 0 : lit[size_t(float(lit.size()) * (1 - kClipped))];
  const float least = visible[size_t(float(visible.size()) * (1 - share))];  // on the brightest such share
  return least > 0 && least > std::max(kDark * bright, kFaint * glow);
}

// Share of the surfaces in the picture that a sun in this direction lights.
float sunlit(const Picture& picture, const Frame& frame, glm::vec3 towardsSun) {
  constexpr float kEnough = 0.5f;  // of the light, where glass stands before the sun
  const std::vector<glm::vec4> shares = meter->sharesFrom(frame, picture, towardsSun);
  uint32_t surfaces = 0, lit = 0;
  for (size_t i = 0; i < picture.size(); ++i) {
    if (!(picture[i].there > 0)) continue;
    ++surfaces;
    lit += glm::dot(picture[i].normal, towardsSun) > 0.1f && brightest(shares[i]) > kEnough;
  }
  return surfaces > 0 ? float(lit) / float(surfaces) : 0;
}

// The sky whose sun leaves about half of the picture in shadow, of those that stand high enough and not behind the
// scene. None if no sun reaches anything. Its ground looks like an assumed floor, which it continues.
std::optional<Sky> findSky(const Picture& picture, const Frame& frame) {
  const glm::vec3 right = frame.scene->cameras[0].orientation * glm::vec3(1, 0, 0);
  const float facing = std::atan2(-right.z, right.x);
  std::optional<Sky> best;
  float most = 0.02f;
  for (const float height : {0.7f, 1.0f, 1.3f})
    for (int i = -4; i <= 4; ++i) {  // in the middle behind the camera
      Sky sky;
      sky.sunElevation = height;
      sky.sunAzimuth = std::remainder(facing + glm::pi<float>() + 0.35f * float(i), glm::two_pi<float>());
      sky.ground = glm::vec3(kGroundReflectance);
      const float lit = sunlit(picture, frame, towardsSun(sky)), balance = lit * (1.2f - lit);
      if (balance > most) most = balance, best = sky;
    }
  return best;
}

// A lamp below the ceiling, a little ahead of the camera.
void addLamp(Scene& scene, const Picture& picture, const RayScene& rays) {
  const Camera& camera = scene.cameras[0];
  std::vector<float> distances;
  for (const MeterPoint& point : picture)
    if (point.there > 0) distances.push_back(glm::distance(point.position, camera.position));
  std::ranges::nth_element(distances, distances.begin() + ptrdiff_t(distances.size() / 2));
  const float far = distances[distances.size() / 2];
  const glm::vec3 ahead = camera.orientation * glm::vec3(0, 0, -1);
  const RayHit wall = rays.intersect({camera.position, ahead});
  const glm::vec3 below = camera.position + ahead * std::min(0.4f * far, wall ? 0.4f * wall.distance : far);
  const RayHit ceiling = rays.intersect({below, {0, 1, 0}});
  Light lamp;
  lamp.name = "default lamp";
  lamp.type = LightType::Point;
  lamp.color = {1, 0.93f, 0.82f};
  lamp.position = below + glm::vec3(0, 0.6f * std::min(ceiling ? ceiling.distance : far, far), 0);
  lamp.intensity = kLamplight * far * far;
  scene.lights.push_back(lamp);
}

}  // namespace

void setLightMeter(const LightMeter& newMeter) { meter = &newMeter; }

std::string addFirstLight(Scene& scene, const Geometry& geometry, bool floorAdded) {
  if (geometry.empty()) return {};
  const Frame frame = firstFrame(scene, geometry);
  const Picture picture = meter->picture(frame);
  const Parts parts = partsOf(scene, geometry, picture, floorAdded);
  // Lamps of the model may leave the floor in the dark.
  const bool floorCounts = scene.lights.empty() && !scene.environmentMap && mostLightsItself(parts.things);
  const float share = scene.lights.empty() ? kSeen : kSeenByLamps;
  if (isLit(parts.things, share, glow(scene, geometry)) &&
      (!floorCounts || floorBrightness(picture, parts.floor) > kDarkFloor))
    return {};
  if (!scene.environmentMap) scene.assumedSky = findSky(picture, frame);
  if (scene.assumedSky) {
    addDaylight(scene, *scene.assumedSky);
    return "a sun and a sky";
  }
  addLamp(scene, picture, *RayScene::cached(scene, geometry, Passing::Met));
  scene.assumedLamp = true;
  return "a lamp";
}

bool firstFloorIsDark(const Scene& scene, const Geometry& geometry) {
  const Picture picture = meter->picture(firstFrame(scene, geometry));
  return floorBrightness(picture, partsOf(scene, geometry, picture, true).floor) <= kDark;
}

float firstExposure(const Scene& scene, const Geometry& geometry) {
  if (geometry.empty()) return 1;
  std::vector<glm::vec3> pixels;
  for (const MeterPoint& point : meter->picture(firstFrame(scene, geometry)))
    if (point.there > 0) pixels.push_back(point.radiance);
  if (pixels.empty()) return 1;
  std::ranges::sort(pixels, {}, brightest);
  const auto display = [&](float exposure) {
    float sum = 0;
    for (const glm::vec3 p : pixels)
      for (int c = 0; c < 3; ++c) sum += image::srgbEncode(std::min(exposure * p[c], 1.0f));
    return sum / float(3 * pixels.size());
  };
  // The greatest exposure with at most this mean display value and this share of clipped pixels.
  const auto greatest = [&](float mean, float clipped) {
    const float bright = brightest(pixels[size_t(float(pixels.size()) * (1 - clipped))]);
    const float most = bright > 0 ? 1 / bright : 0;
    float low = 1e-6f * most, high = most;
    if (display(high) > mean)
      for (int i = 0; i < 30; ++i) {
        const float middle = std::sqrt(low * high);
        (display(middle) < mean ? low : high) = middle;
      }
    return high;
  };
  const float exposure = std::max(greatest(kDisplay, kClipped), greatest(kDisplayInDark, kClippedInDark));
  if (exposure == 0) return 1;
  const float unit = std::pow(10.0f, std::floor(std::log10(exposure)) - 1);
  return std::round(exposure / unit) * unit;
}

FirstView addFirstView(Scene& scene) {
  Geometry geometry = flatten(scene);
  FirstView added;
  added.camera = addFirstCamera(scene, geometry);
  if (!added.camera.empty()) added.floor = addFirstFloor(scene, geometry);
  if (!added.floor.empty()) geometry = flatten(scene);
  added.light = addFirstLight(scene, geometry, !added.floor.empty());
  if (!added.floor.empty() && added.light.empty() && firstFloorIsDark(scene, geometry)) {
    removeFloor(scene);
    geometry = flatten(scene);
    added.floor.clear();
  }
  scene.assumed = true;
  scene.assumedFloor = !added.floor.empty();
  scene.exposure = firstExposure(scene, geometry);
  if (scene.exposure != 1) added.exposure = fmt::format("the exposure {:.2g}", scene.exposure);
  if (!scene.environmentMap && scene.environment == glm::vec3(0))
    scene.environment = kBackground / scene.exposure;
  return added;
}

}  // namespace fovea::scene
