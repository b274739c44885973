// Modelling toolkit of the built-in scenes: outlines, solids made from them, surfaces, and the builders that gather
// them into meshes and scenes. Right-handed, Y up, metres.
//
// A Shape is a set of triangles without a material: MeshBuilder::add gives it a material and a place. Texture
// coordinates are metres along the surface, u to the right and v down, as in pictures, so that a texture has the same
// scale everywhere: SceneBuilder::material takes the number of metres that a picture spans. Solids are closed; open
// shapes such as sheets can have a thickness or a double-sided material.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "framework/scene/scene.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene::model {

// 0 below `low`, 1 above `high`, smooth between.
inline float smoothstep(float low, float high, float x) { return glm::smoothstep(low, high, x); }

using Shape = Primitive;  // `material` is not used

inline constexpr float kCrease = 35;  // degrees: edges that turn more than this stay sharp

// ---- Noise: hashes, the same on every machine ------------------------------------------------------------

float random(uint32_t seed, uint32_t index);                         // [0, 1)
float random(uint32_t seed, uint32_t index, float low, float high);  // [low, high)
// Smooth value noise in [0, 1) with cells of edge 1; repeats after `period` cells, or never if that is 0.
float noise(glm::vec2 p, uint32_t seed, int period = 0);
// Sum of `octaves` noises, each twice as fine and half as strong; in [0, 1).
float fractal(glm::vec2 p, uint32_t seed, int octaves, int period = 0);

// ---- Placement -------------------------------------------------------------------------------------------

glm::mat4 at(float x, float y, float z);
glm::mat4 at(glm::vec3 p);
glm::mat4 turnX(float degrees);
glm::mat4 turnY(float degrees);
glm::mat4 turnZ(float degrees);
glm::mat4 scaled(float s);
glm::mat4 scaled(float x, float y, float z);  // a negative factor mirrors; windings are corrected
// Frame with its Z axis along `direction`, its Y axis as close to `up` as possible, and its origin at p.
glm::mat4 facing(glm::vec3 p, glm::vec3 direction, glm::vec3 up = {0, 1, 0});

// ---- Outlines --------------------------------------------------------------------------------------------

// A chain of points in a plane, built like the path of a pen. Used for profiles of lathes (x is the
// radius, y the height; from bottom to top with the solid to the left), sections of sweeps, and outlines
// of extrusions (counter-clockwise).
class Outline {
 public:
  Outline() = default;
  explicit Outline(glm::vec2 start) : points_{start} {}
  Outline(std::initializer_list<glm::vec2> points) : points_(points) {}

  Outline& line(float x, float y);
  Outline& by(float dx, float dy);  // line, relative
  // An arc to (x, y) with bulge = tan(angle / 4): 1 is a half circle, 0.4142 a quarter circle. A positive bulge bends
  // to the right of the direction of travel, so that a counter-clockwise outline swells.
  Outline& arc(float x, float y, float bulge, int steps = 6);
  // Cubic Bezier curve.
  Outline& curve(glm::vec2 control1, glm::vec2 control2, glm::vec2 end, int steps = 8);
  // A smooth (Catmull-Rom) curve from the current point through the given ones.
  Outline& through(const std::vector<glm::vec2>& points, int stepsEach = 4);
  Outline& append(const Outline& other);

  Outline moved(glm::vec2 by) const;
  Outline scaled(glm::vec2 by) const;
  Outline reversed() const;
  const std::vector<glm::vec2>& points() const { return points_; }

 private:
  std::vector<glm::vec2> points_;
};

Outline circle(float radius, int sides);
Outline rectangle(float width, float height);  // about the origin
Outline roundedRectangle(float width, float height, float radius, int steps = 3);
// A wall panel from (-width/2, 0) to (width/2, height) with an opening of clear width `opening`, open at the bottom,
// whose round arch springs at `spring`. With rise < opening / 2 the arch is segmental.
Outline archedPanel(float width, float height, float opening, float spring, int steps = 16,
                    std::optional<float> rise = {});
// The opening alone as a closed outline, from `sill` upwards.
Outline archedOpening(float opening, float sill, float spring, int steps = 16,
                      std::optional<float> rise = {});
float signedArea(const std::vector<glm::vec2>& polygon);

// Triangles (indices into `outer` followed by the points of the holes) of a simple polygon, whose parts may
// have any orientation.
std::vector<uint32_t> triangulate(const std::vector<glm::vec2>& outer,
                                  const std::vector<std::vector<glm::vec2>>& holes = {});

// ---- Solids ----------------------------------------------------------------------------------------------

// A box between two corners. Edges are rounded by `bevel` in `bevelSteps` steps (with 2, an edge has two
// strips); without a bevel the box has 12 triangles. `cells` subdivides the flat part of each face, for shapes
// that are bent later.
struct BoxOptions {
  float bevel = 0;
  int bevelSteps = 1;  // steps of half an edge
  glm::ivec3 cells{1};
  bool bottom = true;  // false for a box whose bottom is never visible
};
Shape box(glm::vec3 low, glm::vec3 high, const BoxOptions& options = {});
// Centred in x and z, standing on y = 0.
Shape block(float width, float height, float depth, const BoxOptions& options = {});

struct LatheOptions {
  int segments = 24;
  float creaseDegrees = kCrease;
  bool closed = false;                     // joins the profile's last point to the first (rings)
  float fromDegrees = 0, toDegrees = 360;  // counter-clockwise from above, 0 is +X; open ends have no caps
  // Factor on the radius over angle (radians) and height, for flutes, petals and wobbles. Normals follow.
  std::function<float(float angle, float y)> swell;
};
Shape lathe(const Outline& profile, const LatheOptions& options = {});
Shape sphere(float radius, int segments = 24, int rings = 12);
Shape cylinder(float radius, float height, int segments = 24, float bevel = 0);  // standing on y = 0
Shape torus(float majorRadius, float minorRadius, int segments = 32, int sides = 12);

struct SweepOptions {
  bool closedPath = false, closedSection = true;
  bool caps = true;  // for a closed section on an open path
  // The section's y axis stays as close to it as possible; if absent, the section does not twist along the path.
  std::optional<glm::vec3> up;
  float creaseDegrees = kCrease;        // corners of the path that turn more are mitred
  std::function<float(float t)> scale;  // of the section, t in 0..1 along the path
  float twistDegrees = 0;               // over the whole path
};
// The section's x axis points to the right of the direction of the path and its y axis up; the
// section is counter-clockwise.
Shape sweep(const std::vector<glm::vec3>& path, const Outline& section, const SweepOptions& options = {});
// A round bar. Its radius may vary along the path: radius(t), t in 0..1.
Shape tube(const std::vector<glm::vec3>& path, float radius, int sides = 8, bool closed = false);
Shape tube(const std::vector<glm::vec3>& path, const std::function<float(float)>& radius, int sides = 8);
// A smooth (Catmull-Rom) path through the points.
std::vector<glm::vec3> smoothPath(const std::vector<glm::vec3>& points, int stepsEach = 6,
                                  bool closed = false);

struct ExtrudeOptions {
  float bevel = 0;  // chamfer of front and back edges
  float creaseDegrees = kCrease;
  bool back = true;  // false: no face at z = 0
};
// Extrudes from z = 0 to z = depth; the front is at z = depth and faces +z.
Shape extrude(const Outline& outline, float depth, const ExtrudeOptions& options = {});
Shape extrude(const Outline& outline, const std::vector<Outline>& holes, float depth,
              const ExtrudeOptions& options = {});

// ---- Surfaces --------------------------------------------------------------------------------------------

// A rectangular net of (columns + 1) * (rows + 1) points, row by row. Row 0 is the upper edge (v = 0). The front is
// the side from which u runs to the right and v down.
struct Sheet {
  uint32_t columns = 1, rows = 1;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;
  size_t index(uint32_t column, uint32_t row) const { return size_t(row) * (columns + 1) + column; }
};
// Samples f(u, v) with u and v in 0..1; `size` gives the metres that u and v span, for the texture.
Sheet sheet(uint32_t columns, uint32_t rows, glm::vec2 size,
            const std::function<glm::vec3(float u, float v)>& f);
// With thickness 0 the surface has one side and needs a double-sided material; otherwise it is a closed solid with
// half of the thickness on each side.
Shape surface(const Sheet& sheet, float thickness = 0);
// Catmull-Clark cage of the net, with its boundaries kept. `shapes` become morph targets that lead from `sheet` to
// each of them; they must have the same columns and rows.
SubdivisionCage cage(const Sheet& sheet, uint32_t level, const std::vector<Sheet>& shapes = {});

// ---- Changes of shapes -----------------------------------------------------------------------------------

void append(Shape& shape, const Shape& what, const glm::mat4& placement = glm::mat4(1));
Shape placed(Shape shape, const glm::mat4& placement);
// Moves every vertex, then recomputes the normals as smooth() does.
Shape bent(Shape shape, const std::function<glm::vec3(glm::vec3)>& f, float creaseDegrees = kCrease);
// Computes normals from the triangles, sharp at edges that turn by more than creaseDegrees, where vertices are split.
void smooth(Shape& shape, float creaseDegrees = kCrease);
size_t triangleCount(const Shape& shape);

// ---- Builders --------------------------------------------------------------------------------------------

// Gathers shapes by material.
class MeshBuilder {
 public:
  MeshBuilder& add(uint32_t material, const Shape& shape, const glm::mat4& placement = glm::mat4(1));
  MeshBuilder& add(const MeshBuilder& other, const glm::mat4& placement = glm::mat4(1));
  size_t triangles() const;
  Mesh take(std::string name);

 private:
  std::vector<Shape> byMaterial_;  // here, `material` is used
};

struct MaterialOptions {
  uint32_t texture = kNoIndex;
  float metres = 1;       // width of the texture in metres
  float metresHigh = 0;   // height of the texture in metres; 0 means as its width
  glm::vec2 offset{0};    // in metres
  float turnDegrees = 0;  // of the texture on the surface
  bool doubleSided = false;
  float alphaCutoff = 0;  // if above 0, masked by the texture's alpha
  glm::vec3 emission{0};
};

class SceneBuilder {
 public:
  explicit SceneBuilder(const std::string& name);

  uint32_t texture(Texture texture);
  // `color`: linear reflectance, multiplied by the texture if there is one.
  uint32_t material(const std::string& name, glm::vec3 color, const MaterialOptions& options = {});
  uint32_t mesh(const std::string& name, MeshBuilder shapes);
  // A surface that deforms. The cage's faces have the materials faceMaterials or, if that is empty, all `material`.
  uint32_t mesh(const std::string& name, SubdivisionCage cage, uint32_t material);
  uint32_t place(const std::string& name, uint32_t mesh, glm::vec3 position = glm::vec3(0),
                 float turnYDegrees = 0, glm::vec3 scale = glm::vec3(1));  // -> node
  // Lets the morph weights of a node swing without end: the weight of target i is amplitude[i] * sin(2 pi (time /
  // period[i] + phase[i])).
  struct Swing {
    float amplitude = 1, period = 3, phase = 0;
  };
  void swing(uint32_t node, const std::vector<Swing>& swings, float loopSeconds);
  void sun(const std::string& name, glm::vec3 color, float lux, glm::vec3 direction);
  void camera(glm::vec3 eye, glm::vec3 target, float verticalFovDegrees, float zNear = 0.05f);

  Scene scene;  // for everything that the functions above do not cover
  Scene finish(float exposure, glm::vec2 gaze = {0.5f, 0.5f});
};

}  // namespace fovea::scene::model
