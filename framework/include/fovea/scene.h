// A scene on the CPU, which loaders produce and all other parts read, and the frames rendered from it. Coordinates are
// right-handed with Y up, in metres, relative to Scene::origin. Colours and reflectances are linear. Light units are
// those of the glTF extension KHR_lights_punctual.
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

// 8-bit RGBA; rows run from top to bottom. `srgb` says that RGB is sRGB-encoded; alpha never is.
struct Texture {
  std::string name;
  uint32_t width = 0, height = 0;
  bool srgb = true;
  std::vector<uint8_t> rgba;  // width * height * 4
};

// A use of a texture by a material: uv' = transform * (u, v, 1), as in KHR_texture_transform.
struct TextureUse {
  uint32_t texture = kNoIndex;
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  // columns: u axis, v axis, offset
  uint32_t set = 0;                         // of texture coordinates: 0 for Primitive::uvs, 1 for secondUvs
  bool nearest = false;                     // shows the nearest texel; otherwise four are interpolated
  explicit operator bool() const { return texture != kNoIndex; }
};

// A surface as glTF 2.0 describes it. Factors are multiplied by their textures, whose channels are named here; textures
// of quantities other than colours are linear (Texture::srgb is false).
//
// A diffuse material uses only some of this: it is Lambertian with reflectance rho = baseColor * (1 - meanMetallic()).
struct Material {
  std::string name;
  glm::vec4 baseColor{1};
  TextureUse baseColorTexture;  // rgba
  float metallic = 0;           // 0: dielectric, 1: metal
  // The mean of the metallic texture, which diffuse materials use in its place; 0 if the model does not mention metal.
  float metallicMean = 1;
  glm::vec3 emission{0};  // radiance, W/(sr m^2): factor times KHR_materials_emissive_strength
  TextureUse emissionTexture;
  bool masked = false;   // alphaMode MASK or BLEND, which diffuse materials take for MASK with cutoff 0.5
  bool blended = false;  // alphaMode BLEND: alpha is the share of light that the surface stops
  float alphaCutoff = 0.5f;
  bool doubleSided = false;

  float roughness = 1;                  // perceptual: the square root of GGX's alpha
  TextureUse metallicRoughnessTexture;  // g: roughness, b: metallic
  TextureUse normalTexture;         // rgb: 2 c - 1 is a normal in the frame of tangent, bitangent and normal
  float normalScale = 1;            // factor on the first two components of that normal
  float ior = 1.5f;                 // index of refraction, at least 1; 0 stands for infinity
  float specular = 1;               // factor on the reflection of dielectrics
  TextureUse specularTexture;       // a
  glm::vec3 specularColor{1};       // factor on the reflection of dielectrics at normal incidence
  TextureUse specularColorTexture;  // rgb
  float transmission = 0;           // share of the light below the surface that goes on, tinted by baseColor
  TextureUse transmissionTexture;   // r
  float clearcoat = 0;              // share of the surface under a coat with index of refraction 1.5
  TextureUse clearcoatTexture;      // r
  float clearcoatRoughness = 0;
  TextureUse clearcoatRoughnessTexture;  // g
  bool unlit = false;                    // shows its base colour; light neither reaches nor leaves it

  float meanMetallic() const { return metallic * metallicMean; }
};

// All textures of a material.
inline constexpr TextureUse Material::*kMaterialTextures[] = {
    &Material::baseColorTexture,    &Material::emissionTexture,  &Material::metallicRoughnessTexture,
    &Material::normalTexture,       &Material::specularTexture,  &Material::specularColorTexture,
    &Material::transmissionTexture, &Material::clearcoatTexture, &Material::clearcoatRoughnessTexture};

// A shape towards which a mesh can be blended: one displacement per vertex, in the space of the mesh.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals;  // either may be empty
};

// Triangles of one material. Positions, normals and uvs have one entry per vertex and are in the space of the mesh.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // unit
  std::vector<glm::vec2> uvs;      // zeros where the model has none
  std::vector<uint32_t> indices;   // three per triangle
  uint32_t material = 0;
  // A coarser triangulation of the same vertices, which voxels and maps of secondary lights see instead of `indices`;
  // empty if they see `indices`.
  std::vector<uint32_t> lightIndices{};
  // For meshes that deform: morph targets are applied first; then the joints of Node::skin move the result.
  std::vector<MorphTarget> targets{};  // the same number in every primitive of a mesh
  // Joints of vertices, indices into Skin::joints: sets of four for each vertex, one set after the other, so that
  // vertex i has entries i, i + n, ... where n is the number of vertices. Empty if not skinned.
  std::vector<glm::u16vec4> joints{};
  std::vector<glm::vec4> weights{};  // of these joints, as many as `joints`; those of a vertex have sum 1
  // What only few models have; each of these lists is empty or has one entry per vertex.
  std::vector<glm::vec2> secondUvs{};  // of textures with set 1
  std::vector<glm::vec4>
      colors{};  // linear, factors on the base colour and, also of diffuse materials, on alpha
  // xyz: unit, the direction of u in the surface; w: 1 or -1, and the bitangent is w * cross(normal, tangent). If empty
  // and the material has a normal map, they follow from the texture coordinates.
  std::vector<glm::vec4> tangents{};
};

class EnvironmentMap;    // framework/scene/environment/environment_map.h
struct SubdivisionCage;  // framework/scene/subdivision/subdivision.h
class Stencils;

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights{};  // of the morph targets, unless the node or an animation sets them
  // A mesh with a cage starts without primitives; they are refined from the cage.
  std::shared_ptr<const SubdivisionCage> cage{};
};

// Joints that move a skinned mesh. A vertex p moves to the sum over its joints of weight * W * B * p, where W is the
// world transform of the joint and B its inverse bind matrix. The transform of the mesh's own node is ignored (glTF
// 2.0, section 3.7.3).
struct Skin {
  std::string name;
  std::vector<uint32_t> joints;        // node indices
  std::vector<glm::mat4> inverseBind;  // one per joint
};

struct Node {
  std::string name;
  uint32_t parent = kNoIndex;  // always a smaller index
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  std::optional<glm::mat4> matrix;  // replaces the three members above if the file gives a matrix
  uint32_t mesh = kNoIndex, camera = kNoIndex, light = kNoIndex;
  bool dynamic = false;          // moves: is an object of its own, drawn and voxelised in every frame
  uint32_t skin = kNoIndex;      // skin of its mesh
  std::vector<float> weights{};  // weights of its mesh's morph targets; empty for those of the mesh
  // The point of the author's space of the node that is 0 here, as Scene::origin is that of the world: not 0 where the
  // author's numbers are too large for single precision (framework/scene/origin.h).
  glm::dvec3 origin{0};
};

enum class LightType : uint32_t { Directional = 0, Point = 1, Spot = 2 };

// `color * intensity` is lux (W/m^2 per channel) for directional lights and candela (W/sr) for the others.
struct Light {
  std::string name;
  LightType type = LightType::Directional;
  glm::vec3 color{1};
  float intensity = 1;
  float range = 0;  // metres; 0 for unlimited
  float innerConeAngle = 0, outerConeAngle = 0.78539816f;
  glm::vec3 position{0};          // world space, metres
  glm::vec3 direction{0, 0, -1};  // world space, unit length, pointing away from the light
};

struct Camera {
  std::string name;
  glm::vec3 position{0};
  glm::quat orientation{1, 0, 0, 0};  // looks along its -Z, its +Y is up
  float verticalFov = 0.8f;           // radians
  float zNear = 0.05f, zFar = 0;      // zFar 0: derived from the size of the scene
  // Width over height of the picture that the author framed; 0 if unknown. In a narrower picture, the vertical field of
  // view grows until both sides of that picture are seen.
  float aspectRatio = 0;
};

// The field of view of one eye behind the lens of a display: angles between the line of sight and the edges of the
// image, in radians. Inward is towards the nose.
struct Lens {
  float outward = 0, inward = 0, up = 0, down = 0;
};
// Degrees. Beyond 80, nearly all of a flat image lies at its edge.
inline constexpr double kLeastLensAngle = 1, kMostLensAngle = 80;

// Clear daylight (framework/scene/environment/sky.h).
struct Sky {
  float turbidity = 3;
  float sunElevation = 0.7f;  // radians above the horizon, from 0 to pi / 2
  float sunAzimuth = 0;       // radians about +Y, counter-clockwise seen from above; 0 has the sun above -Z
  float illuminance = 3;      // lux on level ground, from sun and sky together, mean of the channels
  glm::vec3 ground{0.2f};     // reflectance of the ground below the horizon
};

struct CameraKey {
  float time = 0;
  Camera camera;
};

// Normalised image coordinates, origin top-left.
struct GazeSample {
  float time = 0;
  glm::vec2 position{0.5f};
  bool valid = true;                     // an invalid sample (a blink) holds the last valid one
  std::optional<glm::vec2> left, right;  // per eye, if tracked; otherwise `position` applies
};

enum class Repeat : uint8_t {
  Once,      // holds the last key
  Loop,      // starts again at the first key
  PingPong,  // runs back and forth
};

// The pose of a node at a given time, relative to its parent. As in glTF animations, it replaces the node's own
// translation and rotation; the scale is kept.
struct MotionKey {
  float time = 0;
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  bool visible = true;  // from this key until the next
};

// A node that moves rigidly along keys, together with everything below it.
struct Mover {
  uint32_t node = kNoIndex;  // neither above nor below the node of another mover
  // If true, the path passes through the keys without jumps in speed and without overshooting them;
  // otherwise it is piecewise linear.
  bool smooth = true;
  Repeat repeat = Repeat::Once;
  std::vector<MotionKey> keys;  // at least one, with increasing times
};

// One animated property of one node, as in section 3.11 of glTF 2.0.
struct AnimationChannel {
  enum class Path : uint8_t { Translation, Rotation, Scale, Weights };
  enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
  uint32_t node = kNoIndex;
  Path path = Path::Translation;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;  // at least one; seconds, increasing
  // Per key: 3 values, 4 for a rotation (x, y, z, w; unit length), or one per morph target for weights. A cubic
  // spline has three such groups per key: the incoming tangent, the value and the outgoing tangent.
  std::vector<float> values;
};

// Channels that play together. Properties of a node that no playing animation sets keep their values.
struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
  bool plays = false;
  float speed = 1;               // seconds of the animation per second
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

inline constexpr double kGazeGap = 0.05;  // s; exceeded by slow trackers, pauses and blinks

struct Scene {
  std::string name, source;  // source: scene file or model
  // The point in the author's world space to which all coordinates below are relative. It is 0 unless the scene lies so
  // far from the author's origin that single precision would lose visible detail (framework/scene/origin.h).
  glm::dvec3 origin{0};
  std::vector<Texture> textures;
  std::vector<Material> materials;  // at least one
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Light> lights;          // world space
  std::vector<Camera> cameras;        // world space; [0] is used
  std::vector<CameraKey> cameraPath;  // empty for a still camera
  std::vector<GazeSample> gaze;
  double gazeGap = kGazeGap;  // s; consecutive samples of the gaze are not joined if they lie further apart
  std::vector<Mover> movers;  // their nodes are dynamic
  std::vector<Skin> skins;
  std::vector<Animation> animations;  // their nodes, all nodes below and meshes they bend are dynamic
  std::vector<LightMotion> lightMotions;
  float ipd = 0.064f;        // distance between the eyes (the views "left" and "right"), metres
  std::optional<Lens> lens;  // of these views; without one they have the camera's field of view
  float exposure = 1;        // display = sRGB(exposure * radiance)
  // Factor on all light as passes store it, so that it fits into half floats; 0 stands for the power of two nearest to
  // the exposure. What is read back from outputs is divided by it again. See scene::preExposure().
  float preExposure = 0;
  // The background: an environment map, which lights the scene, or else a radiance that is only visible.
  std::shared_ptr<const EnvironmentMap> environmentMap;
  glm::vec3 environment{0};
  // The value of `$scene.materials` in graphs: `full`, all properties of the materials, or else `diffuse`.
  bool fullMaterials = false;
  uint64_t hash = 0;  // hash of all content, for caches and reports
  // What a model lacks and load() has assumed: camera, exposure, background and full materials. An assumed floor is the
  // last node; an assumed lamp, or the sun of an assumed sky, is the last light.
  bool assumed = false, assumedFloor = false, assumedLamp = false;
  std::optional<Sky> assumedSky;
};

// A range of the triangles in Geometry. Object 0 holds all static geometry. An object that is invisible at the time
// keeps its triangles, with zero area.
struct Object {
  std::string name;
  uint32_t firstTriangle = 0, triangleCount = 0;
  uint32_t firstVertex = 0, vertexCount = 0;
  uint32_t node = kNoIndex;  // its mesh's space is the object space; object 0 uses world space
  bool dynamic = false;
  bool deforms = false;                       // morph targets or joints move its vertices individually
  uint32_t firstJoint = 0, jointCount = 0;    // range of Frame::joints; empty if the node places the object
  uint32_t firstWeight = 0, weightCount = 0;  // range of Frame::weights
  std::shared_ptr<const Stencils> stencils;   // of a deforming cage; they yield its vertices
  // Bounding box of its vertices in object space. If the object deforms, the box is in world space and
  // covers the whole animation.
  glm::vec3 low{0}, high{0};
};

struct Triangle {
  uint32_t v[3];
  uint32_t materialAndObject;  // material in the low 16 bits, object in the high 16 bits
  uint32_t material() const { return materialAndObject & 0xffffu; }
  uint32_t object() const { return materialAndObject >> 16; }
};

// The tangents of a triangle in terms of itself, so that they follow it however it moves: tangent k is
// corners[k].x * (p1 - p0) + corners[k].y * (p2 - p0) + corners[k].z * n, not normalised, where n is the normal on the
// side seen counter-clockwise, with the length sqrt(|(p1 - p0) x (p2 - p0)|). All zeros if there are none.
struct TriangleTangents {
  glm::vec3 corners[3]{};
  float bitangentSign = 0;  // bitangent = bitangentSign * cross(normal, tangent)
};

// The world-space triangles of a whole scene at one time, the static ones first.
struct Geometry {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  // Empty if no primitive has any; else one per vertex, zeros and ones where a primitive has none.
  std::vector<glm::vec2> secondUvs;
  std::vector<glm::vec4> colors;
  std::vector<TriangleTangents> tangents;  // parallel to `triangles`; empty if no material has a normal map
  std::vector<Triangle> triangles;
  std::vector<Object> objects;
  uint32_t staticTriangles = 0;  // triangles [0, staticTriangles) never move
  // flatten() fills these. Whoever changes triangles, uvs, vertices that never move, or materials afterwards flattens
  // again, or sets the hash of all that rays hit but moving vertices to 0, which stands for unknown.
  uint64_t stillKey = 0;
  std::vector<uint32_t> emissive;  // numbers of the triangles whose material emits, ascending
  // The triangles that voxels and maps of secondary lights see if any part of the scene is coarser for them; static
  // ones come first. If empty, they see `triangles`.
  std::vector<Triangle> lightTriangles;
  uint32_t staticLightTriangles = 0;
  glm::vec3 boundsMin{std::numeric_limits<float>::max()}, boundsMax{std::numeric_limits<float>::lowest()};
  // 4 V / S with the volume V of the bounds and the area S of all triangles at time 0, m: the mean chord of a room.
  float meanFreePath = 0;
  bool empty() const { return triangles.empty(); }
  // Vertices [0, staticVertices()) never move.
  uint32_t staticVertices() const {
    return objects.size() > 1 ? objects[1].firstVertex : uint32_t(positions.size());
  }

  // The triangles that voxels and maps of secondary lights see, by their numbers on the device, where
  // `lightTriangles` follow `triangles`.
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

// One eye. Clip space follows Vulkan: x points right, y down, and depth is 0 at the near plane and 1 at the far plane.
struct View {
  std::string name = "main";
  glm::mat4 worldToView{1}, viewToClip{1}, worldToClip{1}, clipToWorld{1};
  glm::mat4 previousWorldToClip{1};
  glm::vec3 eye{0};
  glm::uvec2 size{0};         // pixels
  glm::vec2 gaze{0.5f};       // normalised image coordinates, origin top-left
  float foveaRadius = 0.25f;  // around the gaze, in image widths
  float pixelsPerDegree =
      0;  // pixels in a degree of what the eye sees; 0: as the perspective of the view has it
  float verticalFov = 0.8f;  // radians, from the lower to the upper edge
  // The position within its pixels that the view samples in this frame and in the last one, in pixels from their
  // centres. The matrices contain it, so that drawing at a pixel's centre samples that position (scene::jitter).
  glm::vec2 jitter{0}, previousJitter{0};
  // World-space direction (not normalised) of the ray through image position p in pixels. Pixel centres are at +0.5.
  glm::vec3 rayDirection(glm::vec2 p) const;
};

// The placement of an object (an index into Geometry::objects). Object space is the space of its node's mesh, so that
// a point that is stored in it follows the object as it moves. Object 0 holds all static geometry;
// its object space is world space.
struct ObjectTransform {
  glm::mat4 toWorld{1}, previousToWorld{1};  // affine transforms of this frame and the last one
  glm::mat4 toObject{1};                     // inverse of toWorld; all zeros if it is singular
  bool visible = true, previousVisible = true;
  // Its vertices move individually (Object::deforms). Points on it are stored by their place in a triangle instead.
  bool deforms = false;

  // These equal the functions of the same names in shaders/scene/scene.glsl.
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
  float exposure = 1;      // factor from radiance to display intensity
  float preExposure = 1;   // factor from radiance to light as passes store it
  bool cameraCut = false;  // the history of the views is invalid
  float saccade = 0;       // 1 in the frame in which the gaze has jumped, then falling linearly to 0
  std::vector<View> views;
  std::vector<Light> lights;
  std::vector<ObjectTransform> objects;  // parallel to Geometry::objects
  // For the deforming objects of this frame and the last one: world transforms of the joints times their inverse bind
  // matrices (Object::firstJoint), and weights of the morph targets (Object::firstWeight).
  std::vector<glm::mat4> joints, previousJoints;
  std::vector<float> weights, previousWeights;
  const Scene* scene = nullptr;
  const Geometry* geometry = nullptr;  // world space, at the time of this frame
  GpuScene* gpu = nullptr;

  const View* findView(std::string_view name) const;
  // Factor from light as passes store it to display intensity: `frame.exposure` in shaders.
  float storedExposure() const { return exposure / preExposure; }
};

// ---- Loading ---------------------------------------------------------------------------------------------------

struct LoadOptions {
  std::string
      environment{};  // an image of the light all around, which replaces the scene's environment; "": none
};

// `nameOrFile` is the bare name of a built-in scene or scene file, or a .json, .gltf or .glb file. A model on its own
// gets what a picture of it needs and it lacks, such as a camera, light and an exposure, with a warning. Throws
// Error(BadInput) with file, place and remedy; for a missing model the message also says where to get it.
Scene load(const std::string& nameOrFile, Diagnostics& warnings, const LoadOptions& options = {});

// A camera at a point that looks at another one, neither of them at the other's place.
Camera lookAt(glm::vec3 position, glm::vec3 target, glm::vec3 up = {0, 1, 0});

// The bare names that load() knows, sorted: built-in scenes, and scene files of the project.
std::vector<std::string> names();

// Makes a scene that a program has put together ready for a session. Primitives without normals get smooth ones, those
// without texture coordinates zeros, and `hash` that of all. Throws Error(BadInput) with every mistake: no triangle, no
// material or no camera, lists of different lengths, numbers of things that are not there, or what is not finite.
void complete(Scene& scene);

// Names of the built-in scenes, sorted. These scenes are generated in code, deterministically, and register
// themselves as passes do.
std::vector<std::string> builtinNames();
// Throws Error(BadInput) listing the valid names.
Scene builtin(const std::string& name);

struct Registration {
  Registration(const char* name, Scene (*make)());
};

}  // namespace fovea::scene

// Use this at namespace scope in the source file that makes the scene: FOVEA_SCENE("name", function).
#define FOVEA_SCENE(name, make) static const ::fovea::scene::Registration registration_##make(name, make)
