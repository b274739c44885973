// Random valid glTF files whose content is known: every kind of accessor, whole numbers in every spelling, materials,
// samplers, skins, morph targets, cameras, lights and animations. All of them load, and to what was written.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::loadText;
using test::TemporaryFolder;
using test::warningsOfText;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kFloat = 5126, kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125;

// One file, and what a loader has to find in it.
class RandomModel {
 public:
  explicit RandomModel(uint32_t seed) : random_(seed) { write(); }

  std::string text;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec4> colors, weights;
  std::vector<glm::u16vec4> joints;
  std::vector<uint32_t> indices;
  std::vector<std::vector<glm::vec3>> targets;
  std::vector<float> targetWeights, times, path;
  Material material;
  Camera camera;
  Light light;
  Node placed;

 private:
  int below(int n) { return int(random_() % uint32_t(n)); }
  bool coin() { return below(2) == 0; }
  // Multiples of 1/64, which are exact in decimal and in binary numbers.
  float fraction(int low, int high) { return float(low * 64 + below((high - low) * 64 + 1)) / 64; }

  // A whole number in one of its spellings.
  std::string whole(int64_t n) {
    const std::string digits = std::to_string(n);
    switch (below(n == 0 ? 3 : 6)) {
      case 0:
        return digits + ".0";
      case 1:
        return digits + "e0";
      case 2:
        return digits + ".00E+0";
      case 3:
        return digits + "0e-1";
      default:
        return digits;
    }
  }

  std::string number(double v) {
    std::string digits = std::to_string(v);
    if (v == std::floor(v) && coin()) digits = whole(int64_t(v));
    return digits;
  }

  template <class List>
  std::string list(const List& values) {
    std::string out;
    for (const auto& v : values) out += (out.empty() ? "" : ",") + number(double(v));
    return "[" + out + "]";
  }

  void store(double v, int type, bool normalized) {
    const auto put = [&](auto value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); };
    if (type == kFloat) return put(float(v));
    const double most = type == kByte            ? 127
                        : type == kUnsignedByte  ? 255
                        : type == kShort         ? 32767
                        : type == kUnsignedShort ? 65535
                                                 : 0;
    const int64_t n = normalized ? std::llround(v * most) : std::llround(v);
    if (type == kByte) return put(int8_t(n));
    if (type == kUnsignedByte) return put(uint8_t(n));
    if (type == kShort) return put(int16_t(n));
    if (type == kUnsignedShort) return put(uint16_t(n));
    put(uint32_t(n));
  }

  static int bytesOf(int type) {
    return type == kByte || type == kUnsignedByte ? 1 : type == kShort || type == kUnsignedShort ? 2 : 4;
  }

  // Adds an accessor, with gaps between its elements or without, and returns its number. `values` become what a loader
  // reads of them.
  int accessor(std::vector<float>& values, int components, int type, bool normalized, bool vertices) {
    static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const size_t count = values.size() / size_t(components);
    const int size = components * bytesOf(type), tight = (size + 3) / 4 * 4,
              stride = vertices ? tight + 4 * below(3) : size;
    while (bytes_.size() % 4) bytes_ += '\0';
    const size_t begin = bytes_.size();
    const bool sparse = vertices && type == kFloat && below(4) == 0;
    for (size_t i = 0; i < count; ++i) {
      for (int k = 0; k < components; ++k) {
        float& v = values[i * size_t(components) + size_t(k)];
        store(sparse && i == 1 ? -99 : v, type, normalized);
        const double most = type == kByte           ? 127
                            : type == kUnsignedByte ? 255
                            : type == kShort        ? 32767
                                                    : 65535;
        if (normalized) v = float(std::llround(v * most)) / float(most);
      }
      if (i + 1 < count) bytes_.append(size_t(stride - size), char(below(256)));
    }
    views_ += (views_.empty() ? "" : ",") + std::string(R"({"buffer":)") + whole(0) + R"(,"byteOffset":)" +
              whole(int64_t(begin)) + R"(,"byteLength":)" + whole(int64_t(bytes_.size() - begin)) +
              (stride != size || (vertices && coin()) ? R"(,"byteStride":)" + whole(stride) : "") + "}";
    const int view = viewCount_++;
    std::string text = R"({"bufferView":)" + whole(view) + (coin() ? R"(,"byteOffset":)" + whole(0) : "") +
                       R"(,"componentType":)" + whole(type) + R"(,"count":)" + whole(int64_t(count)) +
                       R"(,"type":")" + kTypes[components] + '"' +
                       (normalized ? R"(,"normalized":true)" : "");
    if (sparse) {
      while (bytes_.size() % 4) bytes_ += '\0';
      const size_t at = bytes_.size();
      bytes_ += std::string("\1\0\0\0", 4);
      for (int k = 0; k < components; ++k) store(values[size_t(components + k)], type, false);
      const auto part = [&](size_t offset, size_t length) {
        views_ += R"(,{"buffer":0,"byteOffset":)" + whole(int64_t(offset)) + R"(,"byteLength":)" +
                  whole(int64_t(length)) + "}";
        return whole(viewCount_++);
      };
      text += R"(,"sparse":{"count":)" + whole(1) + R"(,"indices":{"bufferView":)" + part(at, 4) +
              R"(,"componentType":)" + whole(kUnsignedByte) + R"(},"values":{"bufferView":)" +
              part(at + 4, bytes_.size() - at - 4) + "}}";
    }
    accessors_ += (accessors_.empty() ? "" : ",") + text + "}";
    return accessorCount_++;
  }

  template <class Vector>
  static std::vector<float> flat(const std::vector<Vector>& list) {
    std::vector<float> out;
    for (const Vector& v : list)
      for (int k = 0; k < int(sizeof(Vector) / sizeof(float)); ++k) out.push_back(v[k]);
    return out;
  }
  template <class Vector>
  static void unflatten(const std::vector<float>& values, std::vector<Vector>& list) {
    for (size_t i = 0; i < list.size(); ++i)
      for (int k = 0; k < int(sizeof(Vector) / sizeof(float)); ++k)
        list[i][k] = values[i * (sizeof(Vector) / sizeof(float)) + size_t(k)];
  }
  template <class Vector>
  int attribute(std::vector<Vector>& list, int type, bool normalized) {
    std::vector<float> values = flat(list);
    const int number = accessor(values, int(sizeof(Vector) / sizeof(float)), type, normalized, true);
    unflatten(values, list);
    return number;
  }

  int unitType() { return coin() ? kFloat : coin() ? kUnsignedByte : kUnsignedShort; }

  std::string primitive() {
    const int count = 3 + below(10);
    for (int i = 0; i < count; ++i) {  // on a circle, so that no triangle is without area
      const double angle = 6.28 * i / count, radius = 1 + below(8);
      positions.push_back(
          {float(radius * std::cos(angle)), float(radius * std::sin(angle)), fraction(-2, 2)});
      uvs.push_back({fraction(0, 1), fraction(0, 1)});
      colors.push_back({fraction(0, 1), fraction(0, 1), fraction(0, 1), fraction(0, 1)});
    }
    const bool quantized = below(4) == 0;
    if (quantized)
      for (glm::vec3& p : positions) p = glm::round(p * 4.0f);
    std::vector<glm::vec3> normals(size_t(count), glm::vec3(0, 0, 1));
    // One accessor a statement, so that their numbers follow this order.
    std::string out =
        R"({"attributes":{"POSITION":)" + whole(attribute(positions, quantized ? kShort : kFloat, false));
    out += R"(,"NORMAL":)" + whole(attribute(normals, quantized ? kByte : kFloat, quantized));
    const int uvType = unitType(), colorType = unitType();
    out += R"(,"TEXCOORD_0":)" + whole(attribute(uvs, uvType, uvType != kFloat));
    if (coin())
      out += R"(,"COLOR_0":)" + whole(attribute(colors, colorType, colorType != kFloat));
    else
      colors.clear();
    if (skinned_) out += jointSets(count);
    out += "}";
    for (uint32_t i = 0; i < uint32_t(count); ++i) indices.push_back(i);
    if (const int type = below(4); type > 0) {
      std::vector<float> values(indices.begin(), indices.end());
      out += R"(,"indices":)" + whole(accessor(values, 1,
                                               type == 1   ? kUnsignedByte
                                               : type == 2 ? kUnsignedShort
                                                           : kUnsignedInt,
                                               false, false));
    }
    const int mode = 4 + below(3);
    if (mode != 4 || coin()) out += R"(,"mode":)" + whole(mode);
    std::vector<uint32_t> triangles;
    for (uint32_t i = 0; i + 2 < uint32_t(count); i += mode == 4 ? 3 : 1)
      for (const uint32_t v :
           {mode == 6 ? 0u : i, mode == 5 ? i + 1 + i % 2 : i + 1, mode == 5 ? i + 2 - i % 2 : i + 2})
        triangles.push_back(v);
    indices = triangles;
    const int morphs = below(4);
    std::string written;
    for (int t = 0; t < morphs; ++t) {
      std::vector<glm::vec3>& moved = targets.emplace_back();
      for (int i = 0; i < count; ++i) moved.push_back({fraction(-1, 1), fraction(-1, 1), fraction(-1, 1)});
      written +=
          (t ? "," : "") + std::string(R"({"POSITION":)") + whole(attribute(moved, kFloat, false)) + "}";
      targetWeights.push_back(fraction(0, 1));
    }
    if (morphs) out += R"(,"targets":[)" + written + "]";
    return out + R"(,"material":)" + whole(0) + "}";
  }

  std::string jointSets(int count) {
    std::string out;
    const int sets = 1 + below(3);
    std::vector<glm::vec4> sums(size_t(count), glm::vec4(0));
    for (int set = 0; set < sets; ++set) {
      std::vector<glm::vec4> j, w;
      for (int i = 0; i < count; ++i) {
        j.push_back({below(2), below(2), below(2), below(2)});
        w.push_back(glm::vec4(1 + below(4), 1 + below(4), 1 + below(4), 1 + below(4)) / 64.0f);
      }
      const int type = unitType();
      const std::string n = std::to_string(set);
      out += ",\"JOINTS_" + n + "\":" + whole(attribute(j, coin() ? kUnsignedByte : kUnsignedShort, false)) +
             ",\"WEIGHTS_" + n + "\":" + whole(attribute(w, type, type != kFloat));
      for (int i = 0; i < count; ++i) {
        joints.push_back(glm::u16vec4(j[size_t(i)]));
        weights.push_back(w[size_t(i)]);
        sums[size_t(i)] += w[size_t(i)];
      }
    }
    for (size_t e = 0; e < weights.size(); ++e) weights[e] /= glm::dot(sums[e % size_t(count)], glm::vec4(1));
    return out;
  }

  std::string materialText() {
    for (int i = 0; i < 4; ++i) material.baseColor[i] = fraction(0, 1);
    material.metallic = fraction(0, 1), material.roughness = fraction(0, 1);
    material.emission = {fraction(0, 1), fraction(0, 1), fraction(0, 1)};
    material.doubleSided = coin();
    material.masked = coin();
    material.alphaCutoff = fraction(0, 1);
    TextureUse& use = material.baseColorTexture;
    const int wraps[] = {10497, 33071, 33648}, mins[] = {9728, 9729, 9984, 9985, 9986, 9987};
    use.wrapU = Wrap(below(3)), use.wrapV = Wrap(below(3));
    use.nearest = coin();
    const bool both = coin();
    const int minimum = mins[(use.nearest ? 0 : 1) + 2 * below(3)];
    const bool isNearest = minimum == 9728 || minimum == 9984 || minimum == 9986;
    use.nearest = both ? use.nearest : isNearest;
    const std::string color = list(std::vector<float>{material.baseColor.x, material.baseColor.y,
                                                      material.baseColor.z, material.baseColor.w});
    return R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":)" + color + R"(,"metallicFactor":)" +
           number(material.metallic) + R"(,"roughnessFactor":)" + number(material.roughness) +
           R"(,"baseColorTexture":{"index":)" + whole(0) + R"(,"texCoord":)" + whole(0) +
           R"(}},"emissiveFactor":)" +
           list(std::vector<float>{material.emission.x, material.emission.y, material.emission.z}) +
           R"(,"alphaMode":")" + (material.masked ? "MASK" : "OPAQUE") + R"(","alphaCutoff":)" +
           number(material.alphaCutoff) + R"(,"doubleSided":)" + (material.doubleSided ? "true" : "false") +
           R"(}],"textures":[{"sampler":)" + whole(0) + R"(,"source":)" + whole(0) +
           R"(}],"samplers":[{"wrapS":)" + whole(wraps[int(use.wrapU)]) + R"(,"wrapT":)" +
           whole(wraps[int(use.wrapV)]) + R"(,"minFilter":)" + whole(minimum) +
           (both ? R"(,"magFilter":)" + whole(use.nearest ? 9728 : 9729) : "") +
           R"(}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC"}])";
  }

  void write() {
    skinned_ = coin();
    const std::string drawn = primitive();
    const std::string mesh = R"("meshes":[{"primitives":[)" + drawn + "]" +
                             (targetWeights.empty() ? "" : R"(,"weights":)" + list(targetWeights)) + "}]";
    const std::string materials = materialText();
    camera.verticalFov = fraction(1, 2), camera.zNear = fraction(1, 2), camera.zFar = fraction(3, 9);
    light.type = LightType(below(3));
    light.intensity = fraction(0, 9), light.range = fraction(0, 9);
    light.color = {fraction(0, 1), fraction(0, 1), fraction(0, 1)};
    light.outerConeAngle = fraction(1, 1), light.innerConeAngle = light.outerConeAngle * fraction(0, 0);
    placed.translation = {fraction(-9, 9), fraction(-9, 9), fraction(-9, 9)};
    placed.scale = {fraction(1, 2), fraction(1, 2), fraction(1, 2)};
    const bool matrix = coin() && !skinned_;
    std::string place;
    if (matrix) {
      std::vector<float> m(16, 0.0f);
      for (int i = 0; i < 3; ++i)
        m[size_t(5 * i)] = placed.scale[i], m[size_t(12 + i)] = placed.translation[i];
      m[15] = 1;
      place = R"("matrix":)" + list(m);
    } else {
      place = R"("translation":)" +
              list(std::vector<float>{placed.translation.x, placed.translation.y, placed.translation.z}) +
              R"(,"scale":)" + list(std::vector<float>{placed.scale.x, placed.scale.y, placed.scale.z});
    }
    std::string animations;
    if (!matrix && coin()) {
      const int keys = 1 + below(4);
      for (int k = 0; k < keys; ++k) {
        times.push_back(float(k) + fraction(0, 1) / 2);
        for (int c = 0; c < 3; ++c) path.push_back(fraction(-9, 9));
      }
      const std::string input = whole(accessor(times, 1, kFloat, false, false)),
                        output = whole(accessor(path, 3, kFloat, false, false));
      animations = R"(,"animations":[{"samplers":[{"input":)" + input + R"(,"output":)" + output +
                   R"(,"interpolation":")" + (coin() ? "LINEAR" : "STEP") + R"("}],"channels":[{"sampler":)" +
                   whole(0) + R"(,"target":{"node":)" + whole(0) + R"(,"path":"translation"}}]}])";
    }
    static constexpr const char* kLights[] = {"directional", "point", "spot"};
    const std::string size = whole(int64_t(bytes_.size()));
    text = R"({"asset":{"version":"2.0"},"scene":)" + whole(0) + R"(,"scenes":[{"nodes":[)" + whole(0) + "," +
           whole(1) + "," + whole(2) + "," + whole(3) + R"(]}],"nodes":[{"mesh":)" + whole(0) + "," + place +
           (skinned_ ? R"(,"skin":)" + whole(0) : "") + R"(},{"camera":)" + whole(0) +
           R"(,"extensions":{"KHR_lights_punctual":{"light":)" + whole(0) + R"(}}},{},{}],)" + mesh + "," +
           materials + (skinned_ ? R"(,"skins":[{"joints":[)" + whole(2) + "," + whole(3) + "]}]" : "") +
           animations + R"(,"cameras":[{"type":"perspective","perspective":{"yfov":)" +
           number(camera.verticalFov) + R"(,"znear":)" + number(camera.zNear) + R"(,"zfar":)" +
           number(camera.zFar) + R"(}}],"extensionsUsed":["KHR_lights_punctual"],
           "extensions":{"KHR_lights_punctual":{"lights":[{"type":")" +
           kLights[int(light.type)] + R"(","intensity":)" + number(light.intensity) + R"(,"range":)" +
           number(light.range) + R"(,"color":)" +
           list(std::vector<float>{light.color.x, light.color.y, light.color.z}) +
           R"(,"spot":{"outerConeAngle":)" + number(light.outerConeAngle) + R"(,"innerConeAngle":)" +
           number(light.innerConeAngle) + R"(}}]}},"accessors":[)" + accessors_ + R"(],"bufferViews":[)" +
           views_ + R"(],"buffers":[{"byteLength":)" + size +
           R"(,"uri":"data:application/octet-stream;base64,)" + test::base64(bytes_) + R"("}]})";
  }

  std::mt19937 random_;
  std::string bytes_, views_, accessors_;
  int viewCount_ = 0, accessorCount_ = 0;
  bool skinned_ = false;
};

template <class Vector>
void expectNear(const std::vector<Vector>& got, const std::vector<Vector>& expected, const char* what) {
  ASSERT_EQ(got.size(), expected.size()) << what;
  for (size_t i = 0; i < got.size(); ++i)
    EXPECT_LT(glm::distance(got[i], expected[i]), 1e-5f) << what << ' ' << i;
}

TEST(GltfRandom, ValidFilesLoadToWhatTheyHold) {
  TemporaryFolder folder;
  for (uint32_t seed = 0; seed < 500 && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const RandomModel m(seed);
    Diagnostics warnings;
    Scene s;
    ASSERT_NO_THROW(s = loadText(folder, m.text, warnings)) << m.text;
    SCOPED_TRACE(warnings.format());
    for (const Diagnostic& d : warnings.list())
      EXPECT_EQ(d.message.find("left out"), std::string::npos) << d.format() << m.text;
    ASSERT_EQ(s.meshes.size(), 1u);
    const Primitive& p = s.meshes[0].primitives.at(0);
    expectNear(p.positions, m.positions, "positions");
    expectNear(p.uvs, m.uvs, "texture coordinates");
    expectNear(p.colors, m.colors, "colours");
    expectNear(p.weights, m.weights, "weights");
    EXPECT_EQ(p.joints, m.joints);
    EXPECT_EQ(p.indices, m.indices);
    ASSERT_EQ(p.targets.size(), m.targets.size());
    for (size_t t = 0; t < m.targets.size(); ++t)
      expectNear(p.targets[t].positions, m.targets[t], "displacements");
    EXPECT_EQ(s.meshes[0].weights, m.targetWeights);
    const Material& a = s.materials.at(0);
    EXPECT_EQ(a.baseColor, m.material.baseColor);
    EXPECT_EQ(a.metallic, m.material.metallic);
    EXPECT_EQ(a.roughness, m.material.roughness);
    EXPECT_EQ(a.emission, m.material.emission);
    EXPECT_EQ(a.masked, m.material.masked);
    EXPECT_EQ(a.alphaCutoff, m.material.alphaCutoff);
    EXPECT_EQ(a.doubleSided, m.material.doubleSided);
    EXPECT_EQ(a.baseColorTexture.nearest, m.material.baseColorTexture.nearest);
    EXPECT_EQ(a.baseColorTexture.wrapU, m.material.baseColorTexture.wrapU);
    EXPECT_EQ(a.baseColorTexture.wrapV, m.material.baseColorTexture.wrapV);
    EXPECT_EQ(s.cameras.at(0).verticalFov, m.camera.verticalFov);
    EXPECT_EQ(s.cameras[0].zNear, m.camera.zNear);
    EXPECT_EQ(s.cameras[0].zFar, m.camera.zFar);
    EXPECT_EQ(s.lights.at(0).type, m.light.type);
    EXPECT_EQ(s.lights[0].intensity, m.light.intensity);
    EXPECT_EQ(s.lights[0].range, m.light.range);
    EXPECT_EQ(s.lights[0].color, m.light.color);
    const glm::mat4 local = localTransform(s.nodes.at(0));
    EXPECT_EQ(glm::vec3(local[3]), m.placed.translation);
    for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(local[i][i], m.placed.scale[i]);
    ASSERT_EQ(s.animations.size(), m.times.empty() ? 0u : 1u);
    if (!m.times.empty()) {
      EXPECT_EQ(s.animations[0].channels.at(0).times, m.times);
      EXPECT_EQ(s.animations[0].channels[0].values, m.path);
    }
    EXPECT_FALSE(flatten(s).triangles.empty());
  }
}

// What the specification forbids, in valid files; each mistake is named with its place.
TEST(GltfRandom, MutationsAreNamed) {
  struct Mutation {
    const char *from, *to, *place;
    bool shown = true;  // or refused
  };
  const Mutation mutations[] = {
      {R"("scene":)", R"("scene":9,"unused":)", "scene"},
      {R"("scene":)", R"("scene":"first","unused":)", "scene"},
      {R"("camera":)", R"("camera":7,"unused":)", "nodes[1].camera"},
      {R"("light":)", R"("light":-1,"unused":)", "KHR_lights_punctual.light"},
      {R"("yfov":)", R"("yfov":0,"unused":)", "cameras[0].perspective.yfov"},
      {R"("znear":)", R"("znear":-1,"unused":)", "cameras[0].perspective.znear"},
      {R"("zfar":)", R"("zfar":0.5,"unused":)", "cameras[0].perspective.zfar"},
      {R"("type":"perspective")", R"("type":"fisheye")", "cameras[0].type"},
      {R"("intensity":)", R"("intensity":-2,"unused":)", "lights[0].intensity"},
      {R"("range":)", R"("range":"far","unused":)", "lights[0].range"},
      {R"("color":[)", R"("color":[1,)", "lights[0].color"},
      {R"("alphaMode":")", R"("alphaMode":"X)", "materials[0].alphaMode"},
      {R"("alphaCutoff":)", R"("alphaCutoff":-1,"unused":)", "materials[0].alphaCutoff"},
      {R"("doubleSided":)", R"("doubleSided":0,"unused":)", "materials[0].doubleSided"},
      {R"("emissiveFactor":[)", R"("emissiveFactor":[0,)", "materials[0].emissiveFactor"},
      {R"("baseColorFactor":[)", R"("baseColorFactor":[0,)",
       "materials[0].pbrMetallicRoughness.baseColorFactor"},
      {R"("metallicFactor":)", R"("metallicFactor":5,"unused":)", "metallicFactor"},
      {R"("roughnessFactor":)", R"("roughnessFactor":-5,"unused":)", "roughnessFactor"},
      {R"("texCoord":)", R"("texCoord":0.5,"unused":)", "baseColorTexture.texCoord"},
      {R"("baseColorTexture":{"index":)", R"("baseColorTexture":{"index":4,"unused":)",
       "baseColorTexture.index"},
      {R"("sampler":)", R"("sampler":6,"unused":)", "sampler"},
      {R"("source":)", R"("source":6,"unused":)", "textures[0].source"},
      {R"("wrapS":)", R"("wrapS":1,"unused":)", "samplers[0].wrapS"},
      {R"("minFilter":)", R"("minFilter":9730,"unused":)", "samplers[0].minFilter"},
      {R"("images":[{)", R"("images":[{"bufferView":0,)", "images[0]"},
      {R"("material":)", R"("material":8,"unused":)", "primitives[0].material"},
      {R"("NORMAL":)", R"("NORMAL":99,"unused":)", "attributes.NORMAL"},
      {R"("TEXCOORD_0":)", R"("TEXCOORD_0":0,"_UNUSED":)", "TEXCOORD_0"},
      {R"("POSITION":)", R"("POSITION":99,"unused":)", "attributes.POSITION", false},
      {R"("attributes":)", R"("unused":)", "primitives[0]", false},
      {R"("mesh":)", R"("mesh":1,"unused":)", "nodes[0].mesh", false},
      {R"("accessors":[{"bufferView":)", R"("accessors":[{"bufferView":77,"unused":)",
       "accessors[0].bufferView", false},
      {R"("buffers":[{"byteLength":)", R"("buffers":[{"byteLength":8,"unused":)", "bufferViews[", false},
      {R"("version":"2.0")", R"("version":"1.1")", "asset.version", false}};
  for (const Mutation& m : mutations)
    for (uint32_t seed = 0; seed < 4; ++seed) {
      std::string text = RandomModel(seed).text;
      const size_t at = text.find(m.from);
      ASSERT_NE(at, std::string::npos) << m.from;
      text.replace(at, std::strlen(m.from), m.to);
      const std::string told = m.shown ? warningsOfText(text) : test::errorOfText(text);
      EXPECT_THAT(told, AllOf(HasSubstr("model.gltf"), HasSubstr(m.place))) << m.to;
    }
}

}  // namespace
}  // namespace fovea::scene
