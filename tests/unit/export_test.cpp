// Tests exported scenes: glTF loads as the same picture, and Mitsuba's files describe the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/image.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/export/gltf.h"
#include "framework/scene/export/mitsuba.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "framework/scene/subdivision/subdivision.h"
#include "scene_support.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using namespace scene;
using testing::HasSubstr;

float distance(const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b); }

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void expectSameTexture(const Scene& a, const TextureUse& ua, const Scene& b, const TextureUse& ub) {
  ASSERT_EQ(bool(ua), bool(ub));
  if (!ua) return;
  const Texture &ta = a.textures[ua.texture], &tb = b.textures[ub.texture];
  EXPECT_EQ(ta.width, tb.width);
  EXPECT_EQ(ta.height, tb.height);
  EXPECT_TRUE(ta.rgba == tb.rgba) << ta.name;
  EXPECT_EQ(ta.srgb, tb.srgb);
  EXPECT_EQ(ua.set, ub.set);
  EXPECT_EQ(ua.wrapU, ub.wrapU);
  EXPECT_EQ(ua.wrapV, ub.wrapV);
  for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(ua.transform[i] - ub.transform[i]), 1e-5f);
}

void expectSameMaterials(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (size_t i = 0; i < a.materials.size(); ++i) {
    const Material &x = a.materials[i], &y = b.materials[i];
    SCOPED_TRACE(x.name);
    EXPECT_EQ(x.name, y.name);
    EXPECT_LT(glm::length(x.baseColor - y.baseColor), 1e-6f);
    EXPECT_FLOAT_EQ(x.metallic, y.metallic);
    EXPECT_LE(distance(x.emission, y.emission), 1e-6f * glm::length(x.emission));
    EXPECT_EQ(x.masked, y.masked);
    EXPECT_EQ(x.blended, y.blended);
    if (x.masked) {
      EXPECT_FLOAT_EQ(x.alphaCutoff, y.alphaCutoff);
    }
    EXPECT_EQ(x.doubleSided, y.doubleSided);
    EXPECT_FLOAT_EQ(x.meanMetallic(), y.meanMetallic());
    const auto scalars = [](const Material& m) {
      return std::array<float, 8>{m.roughness,          m.normalScale,  m.ior,
                                  m.specular,           m.transmission, m.clearcoat,
                                  m.clearcoatRoughness, float(m.unlit)};
    };
    EXPECT_EQ(scalars(x), scalars(y));
    EXPECT_EQ(x.specularColor, y.specularColor);
    for (const auto use : kMaterialTextures)
      if (use != &Material::emissionTexture) expectSameTexture(a, x.*use, b, y.*use);
    if (x.emission != glm::vec3(0)) expectSameTexture(a, x.emissionTexture, b, y.emissionTexture);
  }
}

void expectSameTangents(const Geometry& a, const Geometry& b) {
  ASSERT_EQ(a.tangents.size(), b.tangents.size());
  for (size_t i = 0; i < a.tangents.size(); ++i) {
    EXPECT_EQ(a.tangents[i].bitangentSign, b.tangents[i].bitangentSign);
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(distance(a.tangents[i].corners[k], b.tangents[i].corners[k]), 1e-5f);
  }
}

void expectSameLights(const std::vector<Light>& a, const std::vector<Light>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    SCOPED_TRACE(a[i].name);
    EXPECT_EQ(a[i].type, b[i].type);
    EXPECT_LT(distance(a[i].color, b[i].color), 1e-6f);
    EXPECT_FLOAT_EQ(a[i].intensity, b[i].intensity);
    if (a[i].type != LightType::Directional) {
      EXPECT_FLOAT_EQ(a[i].range, b[i].range);
      EXPECT_LT(distance(a[i].position, b[i].position), 1e-5f);
    }
    if (a[i].type != LightType::Point) {
      EXPECT_LT(distance(a[i].direction, b[i].direction), 1e-5f);
    }
    if (a[i].type == LightType::Spot) {
      EXPECT_FLOAT_EQ(a[i].innerConeAngle, b[i].innerConeAngle);
      EXPECT_FLOAT_EQ(a[i].outerConeAngle, b[i].outerConeAngle);
    }
  }
}

void expectSameView(const View& a, const View& b) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(a.worldToClip[c][r], b.worldToClip[c][r], 2e-4f);
  EXPECT_LT(glm::length(a.gaze - b.gaze), 1e-6f);
}

// Compares all geometry at 0 s and at a later time. The triangles are in the same order, whatever node they belong
// to. The normals of a cage that deforms come back as sums of the normals of its shapes, which are not quite those of
// the limit surface.
void expectSameScene(const Scene& a, const Scene& b, float normalError) {
  expectSameMaterials(a, b);
  Geometry ga = flatten(a), gb = flatten(b);
  ASSERT_EQ(ga.triangles.size(), gb.triangles.size());
  ASSERT_EQ(ga.positions.size(), gb.positions.size());
  EXPECT_EQ(ga.staticTriangles, gb.staticTriangles);
  ASSERT_EQ(ga.objects.size(), gb.objects.size());
  for (size_t i = 0; i < ga.triangles.size(); ++i) {
    EXPECT_EQ(ga.triangles[i].materialAndObject, gb.triangles[i].materialAndObject);
    for (int k = 0; k < 3; ++k) ASSERT_EQ(ga.triangles[i].v[k], gb.triangles[i].v[k]);
  }
  const float scale = glm::length(ga.boundsMax - ga.boundsMin);
  for (const uint64_t index : {0, 50}) {
    const Frame fa = makeFrame(a, ga, {640, 480}, index, 1), fb = makeFrame(b, gb, {640, 480}, index, 1);
    moveObjects(fa, ga);
    moveObjects(fb, gb);
    float position = 0, normal = 0, uv = 0;
    for (size_t i = 0; i < ga.positions.size(); ++i) {
      position = std::max(position, distance(ga.positions[i], gb.positions[i]));
      normal = std::max(normal, distance(ga.normals[i], gb.normals[i]));
      uv = std::max(uv, glm::length(ga.uvs[i] - gb.uvs[i]));
    }
    EXPECT_LE(position, 1e-5f * scale) << "frame " << index;
    EXPECT_LE(normal, normalError) << "frame " << index;
    EXPECT_LE(uv, 1e-5f) << "frame " << index;
    EXPECT_EQ(ga.secondUvs, gb.secondUvs);
    expectSameTangents(ga, gb);
    expectSameLights(fa.lights, fb.lights);
    expectSameView(fa.views[0], fb.views[0]);
    expectSameView(fa.views[1], fb.views[1]);
    EXPECT_FLOAT_EQ(fa.exposure, fb.exposure);
  }
  ASSERT_EQ(bool(a.environmentMap), bool(b.environmentMap));
  if (!a.environmentMap) {
    EXPECT_LT(distance(a.environment, b.environment), 1e-6f);
    return;
  }
  EXPECT_FLOAT_EQ(a.environmentMap->turn(), b.environmentMap->turn());
  EXPECT_EQ(a.environmentMap->texels(), b.environmentMap->texels());
}

void roundTrip(const Scene& scene, float normalError = 1e-5f) {
  const TemporaryFolder folder;
  Diagnostics warnings;
  const auto file = exportGltf(scene, folder.path() / "deep" / "er", warnings);
  expectSameScene(scene, load(file.string(), warnings), normalError);
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
}

Texture texture(uint32_t width, uint32_t height) {
  Texture t{"a texture.jpg", width, height, true, {}};
  for (uint32_t i = 0; i < width * height * 4; ++i) t.rgba.push_back(uint8_t(i * 37 + i / 7));
  return t;
}

Primitive quad(glm::vec3 corner, glm::vec3 u, glm::vec3 v, uint32_t material) {
  Primitive p;
  p.positions = {corner, corner + u, corner + u + v, corner + v};
  p.normals.assign(4, glm::normalize(glm::cross(u, v)));
  p.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  p.material = material;
  return p;
}

// A scene with a bit of everything that a scene can hold.
Scene everything() {
  Scene s;
  s.name = "a bit/of everything";
  s.textures = {texture(8, 4), texture(5, 3), texture(4, 6)};
  s.textures[2].srgb = false;
  s.materials.resize(3);
  s.materials[0].name = "tiles";
  s.materials[0].baseColor = {0.5f, 0.25f, 0.75f, 1};
  s.materials[0].baseColorTexture = {0, Wrap::Mirror, Wrap::Clamp,
                                     glm::mat3x2{1.6f, -1.2f, 0.3f, 0.4f, 0.1f, -2}};
  s.materials[0].metallic = 0.3f;
  s.materials[1].name = "leaf";
  s.materials[1].baseColorTexture = {1};
  s.materials[1].masked = s.materials[1].doubleSided = true;
  s.materials[1].alphaCutoff = 0.37f;
  Material& leaf = s.materials[1];
  leaf.metallic = 0.5f;
  leaf.roughness = 0.4f;
  leaf.metallicRoughnessTexture = leaf.clearcoatTexture = leaf.clearcoatRoughnessTexture = {2};
  leaf.metallicRoughnessTexture.set = 1;
  leaf.normalTexture = {2, Wrap::Clamp};
  leaf.normalScale = 0.25f;
  leaf.ior = 1.33f;
  leaf.specular = 0.5f;
  leaf.specularColor = {0.5f, 2, 0.25f};
  leaf.specularTexture = leaf.transmissionTexture = {2};
  leaf.specularColorTexture = {0};
  leaf.transmission = 0.75f;
  leaf.clearcoat = 0.6f;
  leaf.clearcoatRoughness = 0.3f;
  s.materials[2].unlit = true;
  s.materials[2].name = "lamp";
  s.materials[2].emission = {12.5f, 3, 0.7f};
  s.materials[2].emissionTexture = {0};
  s.meshes = {
      {"room", {quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 0), quad({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)}},
      {"lamp", {quad({-1, 2, -1}, {0, 0, 1}, {1, 0, 0}, 2)}}};
  uint32_t blue = 0;  // the loader takes the mean of metal from the texture
  for (size_t i = 2; i < s.textures[2].rgba.size(); i += 4) blue += s.textures[2].rgba[i];
  leaf.metallicMean = float(blue / (255.0 * double(s.textures[2].rgba.size() / 4)));
  s.meshes[0].primitives[1].secondUvs = {{0, 0.5f}, {1, 0.5f}, {1, 0.25f}, {0, 0.25f}};
  s.meshes[0].primitives[1].tangents.assign(4, {0.6f, 0.8f, 0, -1});
  s.nodes.resize(4);
  s.nodes[0].name = s.nodes[1].name = s.nodes[3].name = "twice";
  s.nodes[0].mesh = 0;
  s.nodes[1].parent = 0;
  s.nodes[1].matrix = glm::mat4{1, 0, 0, 0, 0.5f, 2, 0, 0, 0, 0, -1, 0, 0.1f, 0.2f, 0.3f, 1};
  s.nodes[1].mesh = 1;
  s.nodes[2].name = "slides";
  s.nodes[2].parent = 0;
  s.nodes[2].mesh = 1;
  s.nodes[2].scale = {0.5f, 1, 0.25f};
  s.nodes[2].dynamic = true;
  s.nodes[3].mesh = 1;
  s.nodes[3].translation = {3, 0.5f, 0};
  s.nodes[3].dynamic = true;  // stands still, an object of its own
  const glm::quat turn = glm::normalize(glm::quat(0.9f, 0.1f, 0.4f, 0.2f));
  s.movers = {
      {2, true, Repeat::PingPong, {{0, {0, 1, 0}, turn, true}, {0.8f, {2, 1, 0}, {1, 0, 0, 0}, true}}}};
  const glm::vec3 down = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  Light sun, bulb, spot;
  sun.name = bulb.name = spot.name = "light";
  sun.direction = spot.direction = down;
  sun.intensity = 3.25f;
  bulb.type = LightType::Point;
  bulb.color = {1, 0.5f, 0.25f};
  bulb.intensity = 40;
  bulb.range = 7;
  bulb.position = {1, 2, 3};
  spot.type = LightType::Spot;
  spot.position = {0, 3, 0.1f};
  spot.innerConeAngle = 0.2f;
  spot.outerConeAngle = 0.6f;
  s.lights = {sun, bulb, spot};
  s.lightMotions = {{1,
                     false,
                     Repeat::Loop,
                     {{0, {1, 2, 3}, {0, 0, -1}, {1, 1, 1}, 40}, {2, {0, 3, 3}, {0, 0, -1}, {1, 0, 0}, 20}}}};
  Camera c;
  c.position = {0.2f, 1, 6};
  c.orientation = glm::normalize(glm::quat(1, 0.05f, 0.1f, 0.02f));
  c.zFar = 30;
  s.cameras = {c};
  s.gaze = {{0, {0.3f, 0.4f}, true, {}, {}},
            {0.5f, {0.6f, 0.7f}, true, glm::vec2(0.61f, 0.7f), glm::vec2(0.59f, 0.7f)}};
  s.exposure = 2.5f;
  s.environment = {0.1f, 0.2f, 0.3f};
  s.ipd = 0.07f;
  return s;
}

TEST(ExportGltf, EverythingComesBack) { roundTrip(everything()); }

TEST(ExportGltf, AnEnvironmentComesBack) {
  Scene s = everything();
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 8; ++i) texels.emplace_back(0.1f + float(i), 2, 1e-3f * float(1 + i));
  s.environmentMap = std::make_shared<EnvironmentMap>(4, 2, std::move(texels), glm::radians(30.0f));
  roundTrip(s);
}

TEST(ExportGltf, ACameraPathComesBack) {
  Scene s = everything();
  Camera c = s.cameras[0];
  s.cameraPath = {{0, c}};
  c.position.x += 1;
  c.verticalFov = 1.1f;
  s.cameraPath.push_back({2, c});
  roundTrip(s);
}

// A flag of two joints with a morph target, both along keys, and a cage that takes another shape.
TEST(ExportGltf, WhatDeformsComesBack) {
  Scene s = everything();
  s.nodes[3].dynamic = false;
  Primitive& flag = s.meshes[1].primitives[0];
  flag.targets = {{{{0, 0, 0}, {0, 0.2f, 0}, {0, 0.3f, 0.1f}, {0, 0, 0}}, {}}};
  flag.joints.assign(4, glm::u16vec4(0, 1, 0, 0));
  flag.weights = {{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}};
  s.meshes[1].weights = {0.5f};
  s.skins = {{"bones", {4, 5}, {glm::mat4(1), glm::inverse(glm::mat4(2))}}};
  s.nodes[3].skin = 0;
  s.nodes.resize(7);
  s.nodes[4].name = "bone 1";
  s.nodes[5].name = "bone 2";
  s.nodes[5].parent = 4;
  SubdivisionCage cage;
  cage.positions = flag.positions;
  cage.faceSizes = {4};
  cage.faceVertices = {0, 1, 2, 3};
  cage.faceMaterials = {2};
  cage.targets = {{{{0, 0.5f, 0}, {0, 0, 0.2f}, {0, 0, 0}, {0.1f, 0, 0}}, {}}};
  s.meshes.push_back({"cage", {}, {0.0f}, std::make_shared<const SubdivisionCage>(cage)});
  s.nodes[6].name = "sheet";
  s.nodes[6].mesh = 2;
  refineCages(s);
  using Path = AnimationChannel::Path;
  using Interpolation = AnimationChannel::Interpolation;
  const float half = std::sqrt(0.5f);
  s.animations = {{"rest", {{4, Path::Scale, Interpolation::Step, {0}, {1, 2, 1}}}},
                  {"wave",
                   {{5, Path::Rotation, Interpolation::Linear, {0, 1.5f}, {0, 0, 0, 1, half, 0, 0, half}},
                    {3, Path::Weights, Interpolation::Linear, {0, 1, 2}, {0, 1, 0.25f}},
                    {6, Path::Weights, Interpolation::Step, {0, 1}, {0, 1}}},
                   true,
                   1.5f,
                   Repeat::PingPong}};
  const Geometry g = flatten(s);
  EXPECT_EQ(std::count_if(g.objects.begin(), g.objects.end(), [](const Object& o) { return o.deforms; }), 3);
  roundTrip(s);
}

TEST(ExportGltf, CornellBoxComesBack) { roundTrip(builtin("cornellbox")); }

TEST(ExportGltf, MovingCornellBoxComesBack) {
  Diagnostics warnings;
  roundTrip(load("cornellbox_moving", warnings), 0.1f);
}

TEST(ExportGltf, SponzaComesBack) {
  FOVEA_NEED_SCENES(folder);
  if (!std::filesystem::exists(folder / "sponza/Sponza.gltf")) GTEST_SKIP() << "no Sponza here";
  Diagnostics warnings;
  Scene sponza = load("sponza", warnings);
  for (Texture& t : sponza.textures) {  // a strip of each: packing them takes all the time
    t.height = std::min(t.height, 16u);
    t.rgba.resize(size_t(t.width) * t.height * 4);
  }
  roundTrip(sponza);
}

TEST(ExportGltf, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  folder.write("file", "in the way");
  Diagnostics warnings;
  const std::string message =
      errorOf([&] { exportGltf(everything(), folder.path() / "file", warnings); }, ExitCode::CannotWrite);
  EXPECT_THAT(message, HasSubstr((folder.path() / "file").string()));
}

TEST(ExportMitsuba, SaysWhatTheSceneSays) {
  const TemporaryFolder folder;
  Diagnostics warnings;
  MitsubaOptions options;
  options.size = {40, 30};
  const auto file = exportMitsuba(everything(), folder.path(), options, warnings);
  const std::string xml = content(file);
  EXPECT_EQ(file.filename(), "a_bit_of_everything.xml");
  EXPECT_THAT(xml, HasSubstr(R"(name="width" value="40")"));
  EXPECT_THAT(xml, HasSubstr(R"(integrator type="volpath")"));  // for the mask
  EXPECT_THAT(xml, HasSubstr(R"(<rgb name="irradiance" value="3.25, 3.25, 3.25"/>)"));
  EXPECT_THAT(xml, HasSubstr(R"(<point name="position" value="1, 2, 3"/>)"));
  EXPECT_THAT(xml, HasSubstr(R"(emitter type="area")"));
  EXPECT_THAT(warnings.format(), HasSubstr("range"));
  EXPECT_THAT(warnings.format(), HasSubstr("environment"));
}

TEST(ExportMitsuba, FullMaterialsAndWhatTheyLack) {
  const TemporaryFolder folder;
  Diagnostics warnings;
  MitsubaOptions options;
  options.full = true;
  const std::string xml = content(exportMitsuba(everything(), folder.path(), options, warnings));
  EXPECT_THAT(xml, HasSubstr(R"(bsdf type="normalmap")"));
  EXPECT_THAT(xml, HasSubstr(R"(bsdf type="principled")"));
  EXPECT_THAT(xml, HasSubstr(R"(bsdf type="roughplastic")"));
  EXPECT_THAT(xml, HasSubstr(R"(<float name="int_ior" value="1.33"/>)"));
  EXPECT_THAT(warnings.format(),
              HasSubstr("`leaf` is written without transmission, clearcoat, specular, the second texture"));
  EXPECT_THAT(warnings.format(), HasSubstr("`lamp` is written without unlit"));
}

// Mitsuba shows all light of an emitter whatever its opacity, so the radiance contains that.
TEST(ExportMitsuba, EmissiveSurfacesShineAsFarAsTheyAreSeen) {
  Scene s;
  s.materials.resize(1);
  s.materials[0].emission = {2, 1, 4};
  s.materials[0].baseColor.a = 0.25f;
  s.materials[0].masked = s.materials[0].blended = true;
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto xml = [&](bool full) {
    const TemporaryFolder folder;
    Diagnostics warnings;
    MitsubaOptions options;
    options.full = full;
    return content(exportMitsuba(s, folder.path(), options, warnings));
  };
  EXPECT_THAT(xml(true), HasSubstr(R"(<rgb name="radiance" value="0.5, 0.25, 1"/>)"));
  EXPECT_THAT(xml(false), HasSubstr(R"(<rgb name="radiance" value="0, 0, 0"/>)"));

  s.textures = {{"leaf", 2, 1, true, {255, 255, 255, 255, 255, 255, 255, 0}}};
  s.materials[0].baseColor.a = 1;
  s.materials[0].baseColorTexture = {.texture = 0, .nearest = true};
  const TemporaryFolder folder;
  Diagnostics warnings;
  const std::string text = content(exportMitsuba(s, folder.path(), {}, warnings));
  const size_t end = text.find("_radiance.exr"), begin = text.rfind("textures/", end);
  ASSERT_NE(end, std::string::npos);
  const image::File file = image::read(folder.path() / (text.substr(begin, end - begin) + "_radiance.exr"));
  const image::Image& radiance = file.layers.at(0).image;
  for (uint32_t c = 0; c < 3; ++c) {
    EXPECT_EQ(radiance.at(radiance.width / 4, 0, c), s.materials[0].emission[int(c)]);
    EXPECT_EQ(radiance.at(3 * radiance.width / 4, 0, c), 0);
  }
}

// The image that a spot light projects holds the falloff; looked up bilinearly, it gives the falloff of the light.
TEST(ExportMitsuba, SpotImageIsTheFalloff) {
  const TemporaryFolder folder;
  Scene s = everything();
  s.lights = {s.lights[2]};
  Diagnostics warnings;
  exportMitsuba(s, folder.path(), {}, warnings);
  const image::File file = image::read(folder.path() / "textures/spot_light.exr");
  const image::Image& falloff = file.layers.at(0).image;
  const float edge = std::tan(0.6f), ci = std::cos(0.2f), co = std::cos(0.6f);
  for (float angle = 0; angle < 0.6f; angle += 0.013f) {
    const float x = (std::tan(angle) / edge * 0.5f + 0.5f) * float(falloff.width) - 0.5f;
    const uint32_t i = uint32_t(x), row = falloff.height / 2;
    if (i + 1 >= falloff.width) break;
    const auto at = [&](uint32_t c) { return 0.5f * (falloff.at(c, row - 1, 0) + falloff.at(c, row, 0)); };
    const float got = glm::mix(at(i), at(i + 1), x - float(i));
    const float s1 = glm::clamp((std::cos(angle) - co) / (ci - co), 0.0f, 1.0f);
    EXPECT_NEAR(got, s1 * s1, 5e-4f) << angle;
  }
}

// The export shows the mover at the requested time.
TEST(ExportMitsuba, ExportsTheMoment) {
  const TemporaryFolder folder;
  Scene s = everything();
  Diagnostics warnings;
  MitsubaOptions options;
  options.time = 0.8;
  exportMitsuba(s, folder.path(), options, warnings);
  const std::string ply = content(folder.path() / "meshes/slides_lamp.ply");
  const size_t header = ply.find("end_header\n") + 11;
  ASSERT_LT(header, ply.size());
  float first[3];
  std::memcpy(first, ply.data() + header, sizeof first);
  EXPECT_LT(distance({first[0], first[1], first[2]}, {2 - 0.5f, 1 + 2, -0.25f}), 1e-5f);
  const std::string xml = content(folder.path() / "a_bit_of_everything.xml");
  EXPECT_EQ(xml.find(R"(value="1, 2, 3")"), std::string::npos);  // the bulb has moved on
}

}  // namespace
}  // namespace fovea::test
