// Chooses a camera by the surfaces in its view, found by rays through the triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "framework/base/low_discrepancy.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/first_view/first_view.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/animation.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kSeed = 0x66697273u;
constexpr int kRays = 24;              // of a view, along each axis
constexpr uint32_t kSpots = 256;       // where an eye might stand
constexpr uint32_t kDirections = 16;   // around such a spot
constexpr uint32_t kBestSpots = 12;    // of which views are compared
constexpr int kMoments = 12;           // of an animation that are looked at
constexpr float kEyeHeight = 1.6f;     // m
constexpr float kEnclosed = 0.75f;     // share of the rays around a spot that hit walls
constexpr float kLeastHidden = 0.05f;  // of the interior view, for an interior camera to be worthwhile
constexpr float kInsideFov = 1.05f, kOutsideFov = 0.7f;  // radians, vertical

struct Looker {
  const Scene& scene;
  const Geometry& geometry;
  const RayScene& rays;
  std::span<const glm::vec3> places;  // of vertices, over time
  glm::vec3 size, centre;
  float diagonal;

  // What a ray hits. front: whether it is a side that the material shows.
  struct Met {
    bool there = false, front = false;
    float distance = 0;
    glm::vec3 normal{0};
    uint32_t material = 0, triangle = kNoIndex;
  };
  Met meet(glm::vec3 from, glm::vec3 direction) const {
    const RayHit hit = rays.intersect({from, direction, 0});
    if (!hit) return {};
    const SurfaceHit surface = surfaceAt(geometry, hit);
    const bool front = glm::dot(surface.geometricNormal, direction) < 0;
    return {true,
            front || scene.materials[surface.material].doubleSided,
            hit.distance,
            front ? surface.geometricNormal : -surface.geometricNormal,
            surface.material,
            hit.triangle};
  }
};

// What a view shows.
struct Shown {
  float surfaces = 0,
        backs = 0;                // shares of its rays that hit a surface, and that hit a back face
  float median = 0, nearest = 0;  // m; distances to the hits
  float close = 0;                // share of the hits that are far nearer than the median
  float planes = 0;               // evenness of the directions that surfaces face, from 0 to 1
  std::set<uint32_t> materials, triangles;
};

// Shannon entropy of the counts, relative to its greatest possible value.
float evenness(const std::array<float, 6>& counts) {
  float sum = 0, entropy = 0;
  for (const float c : counts) sum += c;
  for (const float c : counts)
    if (c > 0) entropy -= c / sum * std::log(c / sum);
  return entropy / std::log(float(counts.size()));
}

Shown look(const Looker& in, const Camera& camera) {
  const View view = makeView(camera, {kRays, kRays}, in.geometry);
  Shown shown;
  std::vector<float> distances;
  std::array<float, 6> facing{};
  for (int y = 0; y < kRays; ++y)
    for (int x = 0; x < kRays; ++x) {
      const glm::vec3 direction = glm::normalize(view.rayDirection(glm::vec2(x, y) + 0.5f));
      const Looker::Met met = in.meet(camera.position, direction);
      if (!met.there) continue;
      if (!met.front) {
        ++shown.backs;
        continue;
      }
      distances.push_back(met.distance);
      shown.materials.insert(met.material);
      shown.triangles.insert(met.triangle);
      const glm::vec3 n = glm::abs(met.normal);
      const int axis = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
      ++facing[2 * size_t(axis) + (met.normal[axis] > 0 ? 1 : 0)];
    }
  constexpr float kAll = float(kRays * kRays);
  shown.surfaces = float(distances.size()) / kAll;
  shown.backs /= kAll;
  if (distances.empty()) return shown;
  std::ranges::sort(distances);
  shown.median = distances[distances.size() / 2];
  shown.nearest = distances.front();
  shown.close = float(std::ranges::lower_bound(distances, 0.2f * shown.median) - distances.begin()) /
                float(distances.size());
  shown.planes = evenness(facing);
  return shown;
}

// The share of what a camera shows that none of these eyes sees.
float hiddenShare(const Looker& in, const Camera& camera, std::span<const glm::vec3> eyes) {
  const View view = makeView(camera, {kRays, kRays}, in.geometry);
  uint32_t shown = 0, hidden = 0;
  for (int y = 0; y < kRays; ++y)
    for (int x = 0; x < kRays; ++x) {
      const glm::vec3 direction = glm::normalize(view.rayDirection(glm::vec2(x, y) + 0.5f));
      const Looker::Met met = in.meet(camera.position, direction);
      if (!met.there) continue;
      const glm::vec3 place = camera.position + met.distance * direction;
      const auto sees = [&](glm::vec3 eye) {
        const float distance = glm::distance(eye, place);
        return in.meet(eye, (place - eye) / distance).distance > 0.999f * distance;
      };
      ++shown;
      hidden += !std::ranges::any_of(eyes, sees);
    }
  return float(hidden) / float(std::max(shown, 1u));
}

// The near plane lies before everything that is shown.
void finish(Camera& camera, const Looker& in, float nearest) {
  camera.name = "default";
  camera.zNear = std::clamp(0.3f * nearest, 2e-5f * in.diagonal, 2e-3f * in.diagonal);
}

// ---- Outside ---------------------------------------------------------------------------------------------------

// Where vertices, of which some are looked at, are in the course of the animations that play.
std::vector<glm::vec3> placesOverTime(const Scene& scene, const Geometry& geometry) {
  std::vector<glm::vec3> places;
  const size_t step = std::max<size_t>(geometry.positions.size() / 20000, 1);
  const auto add = [&](const Geometry& at) {
    for (size_t i = 0; i < at.positions.size(); i += step) places.push_back(at.positions[i]);
  };
  add(geometry);
  double length = 0;
  for (const Animation& a : scene.animations)
    if (a.plays) length = std::max(length, double(duration(a) / std::max(a.speed, 1e-6f)));
  if (!(length > 0)) return places;
  Geometry moving = geometry;
  for (int i = 1; i < kMoments; ++i) {
    Moment moment;
    moment.time = moment.before = length * i / kMoments;
    moveObjects(makeFrame(scene, geometry, glm::uvec2(1), moment, 0), moving);
    add(moving);
  }
  return places;
}

// Places a camera where everything just fills its picture.
void fit(Camera& camera, const Looker& in) {
  const float slope = std::tan(0.5f * camera.verticalFov) * 0.94f;  // leaves a narrow border
  const glm::quat toView = glm::inverse(camera.orientation);
  // A camera at c, in its own axes, sees p if |p.x - c.x| <= slope (c.z - p.z), and so for y.
  glm::vec2 low(-std::numeric_limits<float>::max()), high = low;
  for (const glm::vec3& place : in.places) {
    const glm::vec3 p = toView * (place - in.centre);
    low = glm::max(low, slope * p.z - glm::vec2(p));
    high = glm::max(high, slope * p.z + glm::vec2(p));
  }
  const glm::vec2 distances = (low + high) / (2 * slope);
  const float distance = std::max({distances.x, distances.y, 1e-3f * in.diagonal});
  camera.position = in.centre + camera.orientation * glm::vec3(0.5f * (high - low), distance);
}

struct Candidate {
  Camera camera;
  Shown shown;
  float score = -1;
};

// Three quarters from the front, which is +Z in glTF, or from another side that shows more of it. eyes: where else one
// may stand, also below.
Candidate fromOutside(const Looker& in, std::vector<glm::vec3>& eyes) {
  Candidate best;
  for (const float pitch : {0.3f, 0.6f})
    for (const float degrees :
         {30.0f, -30.0f, 60.0f, -60.0f, 0.0f, 150.0f, -150.0f, 120.0f, -120.0f, 180.0f}) {
      const float yaw = glm::radians(degrees);
      const glm::vec3 from(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
      Candidate c;
      c.camera.verticalFov = kOutsideFov;
      c.camera.orientation = lookAlong(-from, {0, 1, 0});
      fit(c.camera, in);
      eyes.push_back(c.camera.position);
      eyes.push_back(2.0f * in.centre - c.camera.position);
      c.shown = look(in, c.camera);
      const float front = 1 - 0.15f * std::abs(yaw) / glm::pi<float>(), level = pitch < 0.5f ? 1 : 0.8f;
      c.score = c.shown.surfaces * (0.5f + c.shown.planes) * front * level;
      if (c.score > best.score) best = c;
    }
  return best;
}

// ---- Inside ----------------------------------------------------------------------------------------------------

struct Spot {
  glm::vec3 eye{0};
  float room = 0;  // m, mean distance to the walls
};

// A place above a floor, if there is one below a point of the scene's box and walls stand around it.
std::optional<Spot> spotAt(const Looker& in, uint32_t index) {
  const auto [u, v] = sobolPair(index, 0, kSeed);
  const glm::vec3 inBox(u, sobol(index, 2, kSeed), v);
  const glm::vec3 start = in.geometry.boundsMin + inBox * in.size;
  const Looker::Met floor = in.meet(start, {0, -1, 0});
  if (!floor.there || !floor.front || floor.normal.y < 0.7f) return {};
  const glm::vec3 ground = start - glm::vec3(0, floor.distance, 0);
  const Looker::Met ceiling = in.meet(ground + glm::vec3(0, 1e-3f * in.diagonal, 0), {0, 1, 0});
  if (ceiling.there && !ceiling.front) return {};
  // The height of an eye, if the scene may be in metres.
  float height = std::clamp(kEyeHeight, 0.02f * in.diagonal, 0.5f * in.size.y);
  if (ceiling.there) height = std::min(height, 0.55f * ceiling.distance);
  Spot spot{ground + glm::vec3(0, height, 0)};
  uint32_t walls = 0, close = 0;
  for (uint32_t i = 0; i < kDirections; ++i) {
    const float angle = glm::two_pi<float>() * (float(i) + 0.5f) / float(kDirections);
    const Looker::Met met = in.meet(
        spot.eye, glm::normalize(glm::vec3(std::cos(angle), 0.15f * float(int(i % 3) - 1), std::sin(angle))));
    if (!met.there) continue;
    if (!met.front) return {};
    ++walls;
    close += met.distance < 0.4f * height;
    spot.room += met.distance / float(kDirections);
  }
  if (float(walls) < kEnclosed * float(kDirections) || close > 1) return {};
  return spot;
}

Candidate fromInside(const Looker& in, std::set<uint32_t>& materials, std::set<uint32_t>& triangles) {
  std::vector<Spot> spots;
  for (uint32_t i = 0; i < kSpots; ++i)
    if (const auto spot = spotAt(in, i)) spots.push_back(*spot);
  if (spots.size() < kSpots / 20) return {};
  std::ranges::stable_sort(spots, std::greater{}, &Spot::room);
  spots.resize(std::min<size_t>(spots.size(), kBestSpots));
  Candidate best;
  for (const Spot& spot : spots)
    for (uint32_t i = 0; i < kDirections; ++i) {
      const float angle = glm::two_pi<float>() * float(i) / float(kDirections);
      Candidate c;
      c.camera.verticalFov = kInsideFov;
      c.camera.position = spot.eye;
      c.camera.orientation = lookAlong({std::sin(angle), -0.06f, -std::cos(angle)}, {0, 1, 0});
      c.shown = look(in, c.camera);
      if (&spot == &spots.front()) {
        materials.insert(c.shown.materials.begin(), c.shown.materials.end());
        triangles.insert(c.shown.triangles.begin(), c.shown.triangles.end());
      }
      const float variety = float(c.shown.materials.size()) / float(in.scene.materials.size());
      c.score = (c.shown.surfaces - 2 * c.shown.backs) * (1 - c.shown.close) * (0.5f + c.shown.planes) *
                (0.5f + variety) * std::sqrt(c.shown.median / in.diagonal);
      if (c.score > best.score) best = c;
    }
  return best;
}

}  // namespace

std::string addFirstCamera(Scene& scene, const Geometry& geometry) {
  if (!scene.cameras.empty()) return {};
  if (geometry.empty()) {
    scene.cameras.emplace_back().name = "default";
    return "a camera";
  }
  const auto rays = RayScene::cached(scene, geometry);
  const glm::vec3 size = geometry.boundsMax - geometry.boundsMin;
  const std::vector<glm::vec3> places = placesOverTime(scene, geometry);
  const Looker in{scene,
                  geometry,
                  *rays,
                  places,
                  size,
                  0.5f * (geometry.boundsMin + geometry.boundsMax),
                  std::max(glm::length(size), 1e-6f)};
  std::vector<glm::vec3> eyes;
  Candidate outside = fromOutside(in, eyes);
  std::set<uint32_t> materials, triangles;
  Candidate inside = fromInside(in, materials, triangles);
  // A room shows back faces from outside, or fewer of its materials; a box looks the same from inside.
  const Shown& seen = outside.shown;
  const bool more = materials.size() != seen.materials.size() ? materials.size() > seen.materials.size()
                                                              : triangles.size() > seen.triangles.size();
  const bool goIn = inside.score > 0 && (seen.backs > 0.5f * seen.surfaces ||
                                         (more && hiddenShare(in, inside.camera, eyes) > kLeastHidden));
  Candidate& chosen = goIn ? inside : outside;
  finish(chosen.camera, in, chosen.shown.nearest);
  scene.cameras.push_back(chosen.camera);
  return goIn ? "a camera inside, at the height of an eye" : "a camera that shows the whole of it";
}

}  // namespace fovea::scene
