// Builds materials and textures, and decodes the images that they use.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fovea/image.h"
#include "framework/base/budget.h"
#include "framework/image/header.h"
#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

using json::Value;

// What checkDocument has found valid; the fallback if it is absent.
double numberOr(const Value* object, std::string_view key, double fallback) {
  const Value* v = memberOf(object, key);
  return v && v->isNumber() ? v->real : fallback;
}

std::array<double, 3> threeOr(const Value* object, std::string_view key, double fallback) {
  std::array<double, 3> out{fallback, fallback, fallback};
  const Value* v = memberOf(object, key);
  for (size_t i = 0; v && i < std::min<size_t>(3, v->items.size()); ++i) out[i] = v->items[i].real;
  return out;
}

glm::vec2 pairOr(const Value* object, std::string_view key, glm::vec2 fallback) {
  const Value* v = memberOf(object, key);
  return v && v->items.size() == 2 ? glm::vec2(v->items[0].real, v->items[1].real) : fallback;
}

Wrap wrapOf(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::Mirror;
    default:
      return Wrap::Repeat;
  }
}

// KHR_texture_transform: translation * rotation * scale. The listing in the text of the extension rotates in the
// opposite direction to its sample model and to every implementation (KhronosGroup/glTF issue 1563); positive angles
// turn u towards -v.
glm::mat3x2 textureTransform(const Value* t) {
  const glm::vec2 offset = pairOr(t, "offset", glm::vec2(0.0f)), scale = pairOr(t, "scale", glm::vec2(1.0f));
  const float angle = float(numberOr(t, "rotation", 0.0));
  const float c = std::cos(angle), s = std::sin(angle);
  return glm::mat3x2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
}

// The texture coordinates that one material reads: two sets at most, by their TEXCOORD numbers.
class TexCoords {
 public:
  // Makes `texCoord` one of the sets if there is room. Returns whether it is 0 or 1, or nothing if it is a third one.
  std::optional<uint32_t> add(int texCoord) {
    for (uint32_t i = 0; i < 2; ++i) {
      if (sets_[i] < 0) sets_[i] = texCoord;
      if (sets_[i] == texCoord) return i;
    }
    return std::nullopt;
  }
  std::array<int, 2> sets() const { return {std::max(sets_[0], 0), sets_[1]}; }

 private:
  std::array<int, 2> sets_ = {-1, -1};
};

class MaterialBuilder {
 public:
  explicit MaterialBuilder(Context& c) : c_(c) {
    findAlike();
    claimMemory();
  }

  Material build(size_t index) {
    const tinygltf::Material& from = c_.model.materials[index];
    const Value* written = &c_.root.find("materials")->items[index];
    const Value* pbr = memberOf(written, "pbrMetallicRoughness");
    place_ = nameOf("materials", index, from.name);
    texCoords_ = {};
    Material m;
    m.name = from.name.empty() ? "material " + std::to_string(index) : from.name;
    const std::vector<double>& color = from.pbrMetallicRoughness.baseColorFactor;
    for (int i = 0; i < 4; ++i)
      m.baseColor[i] = unitValue(color.size() == 4 ? color[size_t(i)] : 1.0, "baseColorFactor");

    // These two first: the set of the first one is the only one that diffuse materials know.
    m.baseColorTexture = use(pbr, "baseColorTexture", Kind::Diffuse);
    emission(from, written, m);
    if (m.baseColorTexture && m.emissionTexture && m.emissionTexture.set != m.baseColorTexture.set)
      c_.warn(
          place_,
          "emissiveTexture uses other texture coordinates than baseColorTexture; diffuse materials read it "
          "with those of the latter");
    metalAndRoughness(pbr, m);
    m.normalTexture = use(written, "normalTexture", Kind::Data);
    m.normalScale = finite(numberOr(memberOf(written, "normalTexture"), "scale", 1), "normalTexture.scale");
    extensions(written, m);
    alpha(from, m);
    m.doubleSided = from.doubleSided;
    c_.texCoordsOfMaterial.push_back(texCoords_.sets());
    return m;
  }

 private:
  float unitValue(double v, const char* what) {
    if (v < -1e-4 || v > 1.0001)
      c_.warn(place_, std::string(what) + " " + std::to_string(v) + " lies outside 0..1 and is clamped");
    return float(std::clamp(v, 0.0, 1.0));
  }

  float finite(double v, const char* what) {
    if (!std::isfinite(float(v))) c_.fail(place_, std::string(what) + " is not a finite number");
    return float(v);
  }

  void emission(const tinygltf::Material& from, const Value* written, Material& m) {
    const double strength =
        numberOr(extensionOf(written, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    for (int i = 0; i < 3 && from.emissiveFactor.size() == 3; ++i)
      m.emission[i] = float(std::max(from.emissiveFactor[size_t(i)] * strength, 0.0));
    if (!std::isfinite(m.emission.x + m.emission.y + m.emission.z))
      c_.fail(place_, "the emission is not a finite number");
    if (m.emission != glm::vec3(0.0f)) m.emissionTexture = use(written, "emissiveTexture", Kind::Diffuse);
  }

  void alpha(const tinygltf::Material& from, Material& m) {
    m.alphaCutoff = float(from.alphaCutoff);
    m.masked = from.alphaMode == "MASK";
    if (from.alphaMode != "BLEND") return;
    c_.warnIfDiffuse(place_,
                     "alphaMode BLEND is drawn as MASK with a cutoff of 0.5, unless materials are full");
    m.masked = m.blended = true;
    m.alphaCutoff = 0.5f;
  }

  // The default in glTF is 1, a pure metal, which is black as a diffuse material. A file that never mentions metal
  // usually comes from an exporter that wrote no material rather than from one that meant a mirror.
  void metalAndRoughness(const Value* pbr, Material& m) {
    m.metallic = unitValue(numberOr(pbr, "metallicFactor", 1), "metallicFactor");
    m.roughness = unitValue(numberOr(pbr, "roughnessFactor", 1), "roughnessFactor");
    m.metallicRoughnessTexture = use(pbr, "metallicRoughnessTexture", Kind::Data);
    if (m.metallicRoughnessTexture && m.metallic > 0.0f) {
      const std::vector<uint8_t>& rgba = c_.scene.textures[m.metallicRoughnessTexture.texture].rgba;
      uint64_t sum = 0;
      for (size_t i = 2; i < rgba.size(); i += 4) sum += rgba[i];
      m.metallicMean = float(double(sum) / (255.0 * double(std::max<size_t>(rgba.size() / 4, 1))));
    } else if (!memberOf(pbr, "metallicFactor") && !memberOf(pbr, "metallicRoughnessTexture")) {
      m.metallicMean = 0;
    }
    if (m.meanMetallic() > 0.99f && m.emission == glm::vec3(0.0f))
      c_.warnIfDiffuse(place_, "a pure metal reflects nothing diffusely and is black as a diffuse material",
                       "set metallicFactor to 0, or render it with full materials");
  }

  void extensions(const Value* written, Material& m) {
    m.ior = finite(numberOr(extensionOf(written, "KHR_materials_ior"), "ior", 1.5), "ior");
    if (const Value* e = extensionOf(written, "KHR_materials_specular")) {
      m.specular = unitValue(numberOr(e, "specularFactor", 1), "specularFactor");
      const std::array<double, 3> color = threeOr(e, "specularColorFactor", 1);
      for (int i = 0; i < 3; ++i)
        m.specularColor[i] = std::max(finite(color[size_t(i)], "specularColorFactor"), 0.0f);
      m.specularTexture = use(e, "specularTexture", Kind::Data);
      m.specularColorTexture = use(e, "specularColorTexture", Kind::Color);
    }
    if (const Value* e = extensionOf(written, "KHR_materials_transmission")) {
      m.transmission = unitValue(numberOr(e, "transmissionFactor", 0), "transmissionFactor");
      m.transmissionTexture = use(e, "transmissionTexture", Kind::Data);
    }
    if (const Value* e = extensionOf(written, "KHR_materials_clearcoat")) {
      m.clearcoat = unitValue(numberOr(e, "clearcoatFactor", 0), "clearcoatFactor");
      m.clearcoatRoughness =
          unitValue(numberOr(e, "clearcoatRoughnessFactor", 0), "clearcoatRoughnessFactor");
      m.clearcoatTexture = use(e, "clearcoatTexture", Kind::Data);
      m.clearcoatRoughnessTexture = use(e, "clearcoatRoughnessTexture", Kind::Data);
      if (memberOf(e, "clearcoatNormalTexture"))
        leftOut("clearcoatNormalTexture of KHR_materials_clearcoat",
                "the coat follows the surface without a normal map");
    }
    m.unlit = extensionOf(written, "KHR_materials_unlit") != nullptr;
    if (const Value* all = memberOf(written, "extensions"))
      for (const json::Member& e : all->members)
        if (!isSupported(e.key)) leftOut(e.key.substr(0, 80), "the material is shown without it");
  }

  // One warning for each thing that a model asks for, at the first material that does.
  void leftOut(const std::string& what, const char* instead) {
    if (leftOut_.insert(what).second) c_.warn(place_, what + " is ignored: " + instead);
  }

  // Textures that diffuse materials read, those of other colours, and those of data, which are linear.
  enum class Kind : uint8_t { Diffuse, Color, Data };

  // A model can be shown without what only full materials read.
  bool readable(size_t image, Kind kind, const char* key) {
    try {
      textureOf(image, kind != Kind::Data);
      return true;
    } catch (const Error& e) {
      c_.warn(place_, std::string(key) + " is ignored: " + e.diagnostics().front().message,
              e.diagnostics().front().remedy);
      return false;
    }
  }

  // The texture that `object` names at `key`.
  TextureUse use(const Value* object, const char* key, Kind kind) {
    TextureUse u;
    const Value* info = memberOf(object, key);
    if (!info) return u;
    const tinygltf::Texture& texture = c_.model.textures[size_t(info->find("index")->integer)];
    if (texture.source < 0) {
      c_.warn(place_, std::string(key) + " names a texture without an image that can be read; it is ignored");
      return u;
    }
    if (kind != Kind::Diffuse && !readable(size_t(texture.source), kind, key)) return u;
    u.texture = textureOf(size_t(texture.source), kind != Kind::Data);
    if (texture.sampler >= 0) {
      u.wrapU = wrapOf(c_.model.samplers[size_t(texture.sampler)].wrapS);
      u.wrapV = wrapOf(c_.model.samplers[size_t(texture.sampler)].wrapT);
    }
    double texCoord = numberOr(info, "texCoord", 0);
    if (const Value* transform = extensionOf(info, "KHR_texture_transform")) {
      u.transform = textureTransform(transform);
      for (int i = 0; i < 3; ++i)
        finite(double(u.transform[i].x + u.transform[i].y), "KHR_texture_transform");
      texCoord = numberOr(transform, "texCoord", texCoord);
    }
    const std::optional<uint32_t> set = texCoords_.add(int(texCoord));
    if (!set)
      c_.warn(place_, std::string(key) + " uses a third set of texture coordinates, TEXCOORD_" +
                          std::to_string(int(texCoord)) + "; it is read with those of the first texture");
    u.set = set.value_or(0);
    return u;
  }

  // An image that is used both as colours and as data gives two textures.
  uint32_t textureOf(size_t image, bool color) {
    image = firstAlike_[image];
    const auto known = textures_.find({image, color});
    if (known != textures_.end()) return known->second;
    Texture t;
    if (const auto other = textures_.find({image, !color}); other != textures_.end()) {
      t = c_.scene.textures[other->second];
    } else {
      image::Image8 pixels = decode(image);
      t.width = pixels.width;
      t.height = pixels.height;
      t.rgba = std::move(pixels.rgba);
    }
    t.name = imageName(image);
    t.srgb = color;
    c_.scene.textures.push_back(std::move(t));
    return textures_[{image, color}] = uint32_t(c_.scene.textures.size() - 1);
  }

  std::string imageName(size_t index) const {
    const tinygltf::Image& image = c_.model.images[index];
    if (!image.uri.empty() && !isDataUri(image.uri)) return image.uri.substr(0, 200);
    return image.name.empty() ? "images[" + std::to_string(index) + "]" : image.name;
  }

  std::string messageName(size_t index) const {
    return c_.source.name + ": " + nameOf("images", index, imageName(index));
  }

  // Images that name the same file or the same part of a buffer are decoded once.
  void findAlike() {
    std::map<std::pair<std::string, int>, size_t> first;
    for (size_t i = 0; i < c_.model.images.size(); ++i) {
      const tinygltf::Image& image = c_.model.images[i];
      std::string file = image.uri;
      if (image.image.empty()) file = resolveUri(c_.source, image.uri).file.string();
      const bool named = !file.empty() || image.bufferView >= 0;
      firstAlike_.push_back(named ? first.emplace(std::pair(file, image.bufferView), i).first->second : i);
    }
  }

  // Before anything is decoded, because a few bytes can claim to be a large picture.
  void claimMemory() {
    constexpr uint64_t kBytes = 8;  // a pixel, in the scene and on the device
    std::set<size_t> used;
    for (const tinygltf::Texture& texture : c_.model.textures)
      if (texture.source >= 0) used.insert(firstAlike_[size_t(texture.source)]);
    uint64_t pixels = 0, bytes = 0;
    for (const size_t i : used) try {
        const std::span<const uint8_t> file = encoded(i);
        const image::HeaderSize size = image::headerSize(file).value_or(image::HeaderSize{});
        if (std::max(size.width, size.height) > kMaxTextureSize) continue;  // is refused
        pixels += size.pixels();
        bytes += file.size();
      } catch (const Error&) {  // a missing file matters only if a material needs it
      }
    if (const std::string reason = image::whyTooPlain(pixels, bytes); !reason.empty())
      throw Error(ExitCode::BadInput, c_.source.name + ": " + reason, "make images of plain colours smaller");
    if (pixels > 0)
      claimContent(pixels * kBytes, fmt::format("{}: {} images of {} million pixels", c_.source.name,
                                                used.size(), (pixels + 999'999) / 1'000'000));
  }

  // The bytes of the file; they are valid until the next call.
  std::span<const uint8_t> encoded(size_t index) {
    const tinygltf::Image& image = c_.model.images[index];
    if (!image.image.empty()) return image.image;
    const ResolvedUri r = resolveUri(c_.source, image.uri);
    if (!r.problem.empty()) throw Error(ExitCode::BadInput, messageName(index) + ": " + r.problem, r.remedy);
    std::error_code ec;
    if (!std::filesystem::exists(r.file, ec))
      throw Error(ExitCode::BadInput, messageName(index) + ": " + whyMissing(r.file),
                  "copy it beside the model, or remove it from the material");
    file_ = readFile(r.file);
    return file_;
  }

  image::Image8 decode(size_t index) {
    const std::string name = messageName(index);
    const std::span<const uint8_t> bytes = encoded(index);
    image::Image8 pixels = image::decode8(bytes.data(), bytes.size(), name);
    if (pixels.width == 0 || pixels.height == 0 || pixels.width > kMaxTextureSize ||
        pixels.height > kMaxTextureSize)
      c_.fail(name, "the texture has " + std::to_string(pixels.width) + " x " +
                        std::to_string(pixels.height) + " pixels; 1 to " + std::to_string(kMaxTextureSize) +
                        " a side can be used");
    return pixels;
  }

  Context& c_;
  std::vector<size_t> firstAlike_;  // for each image, the first one with the same content
  std::vector<uint8_t> file_;       // what encoded() has read
  std::map<std::pair<size_t, bool>, uint32_t> textures_;  // by image and whether it holds colours
  std::set<std::string> leftOut_;
  std::string place_;
  TexCoords texCoords_;
};

}  // namespace

void buildMaterials(Context& c) {
  MaterialBuilder builder(c);
  for (size_t i = 0; i < c.model.materials.size(); ++i) c.scene.materials.push_back(builder.build(i));
}

}  // namespace fovea::scene::gltf
