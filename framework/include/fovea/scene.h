// A scene on the CPU, which loaders produce and everything else reads, and what one frame looks at.
// Right-handed, Y up, metres; colours and reflectances linear; light units as in glTF KHR_lights_punctual.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"

namespace fovea::scene {

inline constexpr uint32_t kNoIndex = ~0u;

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

// 8-bit RGBA, rows from the top. `srgb`: RGB is sRGB-encoded (alpha never is).
struct Texture {
  std::string name;
  uint32_t width = 0, height = 0;
  bool srgb = true;
  std::vector<uint8_t> rgba;  // width * height * 4
};

// A texture as a material uses it. uv' = transform * (u, v, 1) (KHR_texture_transform).
struct TextureUse {
  uint32_t texture = kNoIndex;
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  // columns: u axis, v axis, offset
  explicit operator bool() const { return texture != kNoIndex; }
};

// Diffuse only: reflectance rho = baseColor * (1 - metallic).
struct Material {
  std::string name;
  glm::vec4 baseColor{1};
  TextureUse baseColorTexture;
  float metallic = 0;
  glm::vec3 emission{0};  // radiance, W/(sr m^2): factor times KHR_materials_emissive_strength
  TextureUse emissionTexture;
  bool masked = false;  // alphaMode MASK; BLEND is treated as MASK with cutoff 0.5
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
};

// A shape that a mesh can take in part: displacements, one a vertex, in the space of the mesh.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals;  // either may be empty: none
};

// Triangles of one material. Positions, normals, uvs have one entry a vertex, in the space of the mesh.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // unit
  std::vector<glm::vec2> uvs;      // zeros where the model has none
  std::vector<uint32_t> indices;   // 3 a triangle
  uint32_t material = 0;
  // Fewer triangles of the same vertices, which voxels and VPL maps see in place of `indices`; empty: the
  // same.
  std::vector<uint32_t> lightIndices{};
  // Of a mesh that deforms. Morph targets come first, then the joints of Node::skin move the result.
  std::vector<MorphTarget> targets{};  // as many in every primitive of a mesh
  std::vector<glm::u16vec4> joints{};  // four a vertex: indices into Skin::joints; empty: not skinned
  std::vector<glm::vec4> weights{};    // of the four joints, sum 1; as many as `joints`
};

struct SubdivisionCage;  // framework/scene/subdivision/subdivision.h
class Stencils;

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights{};  // of the morph targets, where neither the node nor an animation says
  // A mesh with a cage has no primitives: they are refined from it.
  std::shared_ptr<const SubdivisionCage> cage{};
};

// Joints that move a skinned mesh. A vertex goes to the sum over its joints of weight * world transform of
// the joint * inverse bind matrix; the transform of the mesh's own node does not count (glTF 2.0, 3.7.3).
struct Skin {
  std::string name;
  std::vector<uint32_t> joints;        // nodes
  std::vector<glm::mat4> inverseBind;  // one a joint
};

struct Node {
  std::string name;
  uint32_t parent = kNoIndex;  // always a smaller index
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  std::optional<glm::mat4> matrix;  // instead of the three above, when the file gives one
  uint32_t mesh = kNoIndex, camera = kNoIndex, light = kNoIndex;
  bool dynamic = false;          // moves: its own object, drawn and voxelised anew every frame
  uint32_t skin = kNoIndex;      // of its mesh
  std::vector<float> weights{};  // of its mesh's morph targets; empty: those of the mesh
};

enum class LightType : uint32_t { Directional = 0, Point = 1, Spot = 2 };

// `color * intensity` is lux (W/m^2 per channel) for directional lights, candela (W/sr) for the others.
struct Light {
  std::string name;
  LightType type = LightType::Directional;
  glm::vec3 color{1};
  float intensity = 1;
  float range = 0;  // 0: unlimited
  float innerConeAngle = 0, outerConeAngle = 0.78539816f;
  glm::vec3 position{0};          // world space, metres
  glm::vec3 direction{0, 0, -1};  // world space, unit, the way the light travels
};

struct Camera {
  std::string name;
  glm::vec3 position{0};
  glm::quat orientation{1, 0, 0, 0};  // looks along its -Z, its +Y is up
  float verticalFov = 0.8f;           // radians
  float zNear = 0.05f, zFar = 0;      // zFar 0: from the scene's size
};

// What a display behind a lens shows one eye: angles between the line of sight and the edges of its picture,
// radians. Inward is the side of the nose.
struct Lens {
  float outward = 0, inward = 0, up = 0, down = 0;
};
inline constexpr double kLeastLensAngle = 1,
                        kMostLensAngle = 80;  // degrees; beyond, a flat picture is all edge

struct CameraKey {
  float time = 0;
  Camera camera;
};

// Normalised image coordinates, origin top-left.
struct GazeSample {
  float time = 0;
  glm::vec2 position{0.5f};
  bool valid = true;                     // an invalid sample (blink) holds the last valid one
  std::optional<glm::vec2> left, right;  // of one eye, where a tracker tells them apart; else `position`
};

enum class Repeat : uint8_t {
  Once,      // holds the last key
  Loop,      // starts again from the first key
  PingPong,  // runs back and forth
};

// Where a node is at a time, relative to the node above it; takes the place of the node's own translation and
// rotation (its scale stays), as an animation of glTF does.
struct MotionKey {
  float time = 0;
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  bool visible = true;  // from this key until the next one
};

// A node that moves rigidly along keys, with everything below it.
struct Mover {
  uint32_t node = kNoIndex;  // not above or below the node of another mover
  bool smooth =
      true;  // through the keys without a jump in speed and without overshooting them; false: straight
  Repeat repeat = Repeat::Once;
  std::vector<MotionKey> keys;  // at least one, times increase
};

// One property of one node along keys, as glTF 2.0 (3.11) has it.
struct AnimationChannel {
  enum class Path : uint8_t { Translation, Rotation, Scale, Weights };
  enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
  uint32_t node = kNoIndex;
  Path path = Path::Translation;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;  // at least one, s, increasing
  // Of each key: 3, for a rotation 4 (x, y, z, w; unit), for weights one a morph target. Of a cubic spline
  // three such groups: the tangent that comes in, the value, the tangent that goes out.
  std::vector<float> values;
};

// Channels that play together. What no channel of a playing animation says of a node stays as it is.
struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
  bool plays = false;
  float speed = 1;               // seconds of the animation in a second
  Repeat repeat = Repeat::Loop;  // from 0 to the last key of all channels
};

struct LightKey {
  float time = 0;
  glm::vec3 position{0}, direction{0, 0, -1}, color{1};
  float intensity = 1;
};

struct LightMotion {
  uint32_t light = kNoIndex;
  bool smooth = true;
  Repeat repeat = Repeat::Once;
  std::vector<LightKey> keys;
};

struct Scene {
  std::string name, source;  // source: the scene file or model
  std::vector<Texture> textures;
  std::vector<Material> materials;  // at least one
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Light> lights;          // world space
  std::vector<Camera> cameras;        // world space; [0] is the one to use
  std::vector<CameraKey> cameraPath;  // empty: a still camera
  std::vector<GazeSample> gaze;
  std::vector<Mover> movers;  // their nodes are dynamic
  std::vector<Skin> skins;
  std::vector<Animation> animations;  // their nodes, what hangs on them and what they bend is dynamic, too
  std::vector<LightMotion> lightMotions;
  float ipd = 0.064f;        // distance between the eyes (the views "left" and "right"), m
  std::optional<Lens> lens;  // of these views; none: they have the camera's field of view
  float exposure = 1;        // display = sRGB(exposure * radiance)
  glm::vec3 environment{0};  // radiance where nothing is hit
  uint64_t hash = 0;         // of all content, for caches and reports
};

// World-space triangles of the whole scene at one time: static objects first. What is invisible at that time
// is there with triangles of no area.
struct Object {
  std::string name;
  uint32_t firstTriangle = 0, triangleCount = 0;
  uint32_t firstVertex = 0, vertexCount = 0;
  uint32_t node = kNoIndex;  // its mesh's space is the object's own space; object 0: the world's
  bool dynamic = false;
  bool deforms = false;                       // morph targets or joints move its vertices one by one
  uint32_t firstJoint = 0, jointCount = 0;    // of Frame::joints; none: the node's transform places it
  uint32_t firstWeight = 0, weightCount = 0;  // of Frame::weights
  std::shared_ptr<const Stencils> stencils;   // of a cage that deforms: they make the vertices
  // Box of its vertices, in its own space. Of one that deforms: in the world, of the whole animation.
  glm::vec3 low{0}, high{0};
};

struct Triangle {
  uint32_t v[3];
  uint32_t materialAndObject;  // material in the low 16 bits, object in the high 16 bits
  uint32_t material() const { return materialAndObject & 0xffffu; }
  uint32_t object() const { return materialAndObject >> 16; }
};

struct Geometry {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<Triangle> triangles;
  std::vector<Object> objects;
  uint32_t staticTriangles = 0;  // triangles [0, staticTriangles) never move
  // What voxels and VPL maps see, where something is coarser for them: all of it, what never moves first.
  // Empty: they see `triangles`.
  std::vector<Triangle> lightTriangles;
  uint32_t staticLightTriangles = 0;
  glm::vec3 boundsMin{std::numeric_limits<float>::max()}, boundsMax{std::numeric_limits<float>::lowest()};
  bool empty() const { return triangles.empty(); }
  // Vertices [0, staticVertices()) never move.
  uint32_t staticVertices() const {
    return objects.size() > 1 ? objects[1].firstVertex : uint32_t(positions.size());
  }

  // Those triangles by the numbers they have on the device, where `lightTriangles` follow `triangles`.
  struct LightTriangles {
    uint32_t first, firstMoving, end;
  };
  LightTriangles light() const {
    const uint32_t all = uint32_t(triangles.size()), coarse = uint32_t(lightTriangles.size());
    if (coarse == 0) return {0, staticTriangles < all ? staticTriangles : all, all};
    return {all, all + staticLightTriangles, all + coarse};
  }
  const Triangle& triangle(uint32_t number) const {
    return number < triangles.size() ? triangles[number] : lightTriangles[number - triangles.size()];
  }
};

// ---- Frames ----------------------------------------------------------------------------------------------------

class GpuScene;

// One eye. Clip space is Vulkan's: x right, y down, depth 0 at the near plane and 1 at the far plane.
struct View {
  std::string name = "main";
  glm::mat4 worldToView{1}, viewToClip{1}, worldToClip{1}, clipToWorld{1};
  glm::mat4 previousWorldToClip{1};
  glm::vec3 eye{0};
  glm::uvec2 size{0};        // pixels
  glm::vec2 gaze{0.5f};      // normalised image coordinates, origin top-left
  float verticalFov = 0.8f;  // radians, from the lower to the upper edge
  // World-space direction (not normalised) of the ray through image position p in pixels; pixel centres are
  // at +0.5.
  glm::vec3 rayDirection(glm::vec2 p) const;
};

// Where an object (index into Geometry::objects) is. An object's own space is that of its node's mesh; what
// is known of a point in it (VplState::localPosition) stays true while the object moves. Object 0 is all that
// never moves; its own space is the world's.
struct ObjectTransform {
  glm::mat4 toWorld{1}, previousToWorld{1};  // this frame's and the last one's; affine
  glm::mat4 toObject{1};                     // inverse of toWorld; zeros where there is none
  bool visible = true, previousVisible = true;
  // Its vertices move one by one (Object::deforms): a point of it keeps its place in a triangle instead.
  bool deforms = false;

  // The same as in shaders/common/scene.glsl.
  glm::vec3 fromObject(glm::vec3 position) const { return glm::vec3(toWorld * glm::vec4(position, 1)); }
  glm::vec3 intoObject(glm::vec3 position) const { return glm::vec3(toObject * glm::vec4(position, 1)); }
  glm::vec3 normalFromObject(glm::vec3 n) const {
    return glm::normalize(glm::transpose(glm::mat3(toObject)) * n);
  }
  glm::vec3 normalIntoObject(glm::vec3 n) const {
    return glm::normalize(glm::transpose(glm::mat3(toWorld)) * n);
  }
};

struct Frame {
  uint64_t index = 0;  // since the start of the sequence
  double time = 0;     // seconds
  uint32_t seed = 0;
  float exposure = 1;
  bool cameraCut = false;  // history of views is void
  std::vector<View> views;
  std::vector<Light> lights;
  std::vector<ObjectTransform> objects;  // as Geometry::objects
  // Of the objects that deform, this frame's and the last one's: the joints' world transforms times their
  // inverse bind matrices (Object::firstJoint), and the weights of morph targets (Object::firstWeight).
  std::vector<glm::mat4> joints, previousJoints;
  std::vector<float> weights, previousWeights;
  const Scene* scene = nullptr;
  const Geometry* geometry = nullptr;  // world space, this frame
  GpuScene* gpu = nullptr;

  const View* findView(std::string_view name) const;
};

// ---- Loading ---------------------------------------------------------------------------------------------------

// nameOrFile: a built-in scene's or scene file's bare name, or a .json, .gltf or .glb file. A model without light or
// camera gets a default view and a sun, with a warning.
// Throws Error(BadInput) with file, place and remedy; for a missing model also where to get it.
Scene load(const std::string& nameOrFile, Diagnostics& warnings);

// Built-in scenes by name, sorted. They are generated in code, deterministically, and registered as passes are.
std::vector<std::string> builtinNames();
// Throws Error(BadInput) listing the names.
Scene builtin(const std::string& name);

struct Registration {
  Registration(const char* name, Scene (*make)());
};

}  // namespace fovea::scene

// At namespace scope in the source file that makes the scene: FOVEA_SCENE("name", function).
#define FOVEA_SCENE(name, make) static const ::fovea::scene::Registration registration_##make(name, make)
