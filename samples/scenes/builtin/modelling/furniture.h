// What several validation and stress scenes are built of: rooms, furniture and lamps. Lengths are in metres; each piece
// stands on y = 0 about the origin and looks along +z unless stated otherwise.
#pragma once

#include <string>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {

// Textures that most of the scenes share. They are near white, for materials that multiply them by a colour.
struct Stock {
  uint32_t plaster, planks, grain, linen, mottled;
};
Stock makeStock(model::SceneBuilder& builder, uint32_t seed);

// Materials of seats and of what stands beside them.
struct SeatLook {
  uint32_t cover, legs, cushion[3];
};
// A sofa with a buttoned back, rolled arms and loose cushions; its back is at z = 0.
model::MeshBuilder sofa(const SeatLook& look, float width, int seats);
model::MeshBuilder pouffe(uint32_t cover, uint32_t legs, float radius, float height);
// A bench with a buttoned leather pad; it runs along x.
model::MeshBuilder paddedBench(uint32_t cover, uint32_t legs, float width, float depth);
model::MeshBuilder roundTable(uint32_t wood, float radius, float height);
model::MeshBuilder rectTable(uint32_t wood, float width, float depth, float height);

// A room from -x to x, 0 to `height` and `back` to `front`, whose walls are `thick`. Without a front it is open.
struct Shell {
  float x = 3, height = 2.8f, back = -2, front = 2, thick = 0.2f;
  uint32_t wall = 0, floor = 0, ceiling = 0;
  bool closed = true;
};
void addShell(model::MeshBuilder& to, const Shell& shell);
// A board around the foot of the walls of a shell.
void addSkirting(model::MeshBuilder& to, const Shell& shell, uint32_t paint, float height);

// A picture in a frame on the wall z = 0, about the origin.
model::MeshBuilder framed(uint32_t frame, uint32_t picture, float width, float height);
// An abstract picture of coloured fields, and the material that spreads it over width x height.
uint32_t painting(model::SceneBuilder& builder, const std::string& name, float width, float height,
                  uint32_t seed);

// `count` upright round bars from (0, 0) to (width, height) between two rails.
model::Shape railing(float width, float height, int count, float radius);

// A lamp shade without top and bottom, which stands on y = 0. Its walls are closed solids.
model::Shape shade(float lower, float upper, float height);

// A vase of 0.28 m, which stands on y = 0.
Shape vase();

// A pot of clay with soil in it, up to 0.9 of its height.
void addPot(model::MeshBuilder& to, uint32_t clay, uint32_t soil, float radius, float height,
            const glm::mat4& where);

// Books that stand side by side along x from the origin, with their spines towards +z.
void addBooks(model::MeshBuilder& to, const uint32_t (&covers)[3], uint32_t paper, int count, float height,
              uint32_t seed, const glm::mat4& where);

// Lights. Candela for both; cones are half angles in degrees.
void addPoint(model::SceneBuilder& builder, const std::string& name, glm::vec3 color, float intensity,
              glm::vec3 where);
void addSpot(model::SceneBuilder& builder, const std::string& name, glm::vec3 color, float intensity,
             glm::vec3 where, glm::vec3 direction, float inner, float outer);

}  // namespace fovea::scene::model
