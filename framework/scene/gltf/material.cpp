// Builds materials and textures, and decodes the images that they use.
#include <fmt/format.h>

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

glm::vec2 pairOr(const Value* object, std::string_view key, glm::vec2 fallback) {
  const Value* v = memberOf(object, key);
  return v && v->items.size() == 2 ? glm::vec2(v->items[0].real, v->items[1].real) : fallback;
}

Wrap wrapOf(int mode) {
  switch (mode) {
    case 33071:
      return Wrap::Clamp;
    case 33648:
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
  explicit MaterialBuilder(Context& c) : c_(c), images_(itemsOf(&c.root, "images")) {
    findAlike();
    claimMemory();
  }

  Material build(size_t index) {
    const Value* written = &c_.root.find("materials")->items[index];
    const Value* pbr = memberOf(written, "pbrMetallicRoughness");
    const std::string name = textOr(written, "name", "");
    place_ = nameOf("materials", index, name);
    texCoords_ = {};
    Material m;
    m.name = name.empty() ? "material " + std::to_string(index) : name;
    const std::vector<Value>& color = itemsOf(pbr, "baseColorFactor");
    for (int i = 0; i < 4; ++i)
      m.baseColor[i] = unitValue(color.size() == 4 ? color[size_t(i)].real : 1.0, "baseColorFactor");

    // These two first: the set of the first one is the only one that diffuse materials know.
    m.baseColorTexture = use(pbr, "baseColorTexture", Kind::Color);
    emission(written, m);
    if (m.baseColorTexture && m.emissionTexture && m.emissionTexture.set != m.baseColorTexture.set)
      c_.warn(
          place_,
          "emissiveTexture uses other texture coordinates than baseColorTexture; diffuse materials read it "
          "with those of the latter");
    metalAndRoughness(pbr, m);
    m.normalTexture = use(written, "normalTexture", Kind::Data);
    m.normalScale =
        finite(numberOr(memberOf(written, "normalTexture"), "scale", 1), 1, "normalTexture.scale");
    extensions(written, m);
    alpha(written, m);
    if (const Value* v = memberOf(written, "doubleSided")) m.doubleSided = v->boolean;
    c_.texCoordsOfMaterial.push_back(texCoords_.sets());
    return m;
  }

 private:
  float unitValue(double v, const char* what) {
    if (v < -1e-4 || v > 1.0001)
      c_.warn(place_, std::string(what) + " " + std::to_string(v) + " lies outside 0..1 and is clamped");
    return float(std::clamp(v, 0.0, 1.0));
  }

  // Numbers that single precision cannot hold have their default value.
  float finite(double v, float fallback, const char* what) {
    if (std::isfinite(float(v))) return float(v);
    c_.warn(place_,
            std::string(what) + " is not a finite number in single precision: it has its default value");
    return fallback;
  }

  void emission(const Value* written, Material& m) {
    const double strength =
        numberOr(extensionOf(written, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    const std::array<double, 3> factor = threeOr(written, "emissiveFactor", 0);
    const double most = std::max({factor[0], factor[1], factor[2]}) * strength;
    if (finite(most, -1, "the emission") == float(most))
      for (int i = 0; i < 3; ++i) m.emission[i] = float(std::max(factor[size_t(i)] * strength, 0.0));
    if (m.emission != glm::vec3(0.0f)) m.emissionTexture = use(written, "emissiveTexture", Kind::Color);
  }

  void alpha(const Value* written, Material& m) {
    const std::string mode = textOr(written, "alphaMode", "OPAQUE");
    m.alphaCutoff = float(numberOr(written, "alphaCutoff", 0.5));
    m.masked = mode == "MASK";
    if (mode != "BLEND") return;
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
    m.ior = finite(numberOr(extensionOf(written, "KHR_materials_ior"), "ior", 1.5), 1.5f, "ior");
    if (const Value* e = extensionOf(written, "KHR_materials_specular")) {
      m.specular = unitValue(numberOr(e, "specularFactor", 1), "specularFactor");
      const std::array<double, 3> color = threeOr(e, "specularColorFactor", 1);
      for (int i = 0; i < 3; ++i)
        m.specularColor[i] = std::max(finite(color[size_t(i)], 1, "specularColorFactor"), 0.0f);
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
  }

  // One warning for each thing that a model asks for, at the first material that does.
  void leftOut(const std::string& what, const char* instead) {
    if (leftOut_.insert(what).second) c_.warn(place_, what + " is ignored: " + instead);
  }

  // Colours and data, which are linear.
  enum class Kind : uint8_t { Color, Data };

  // The texture that `object` names at `key`.
  TextureUse use(const Value* object, const char* key, Kind kind) {
    TextureUse u;
    const Value* info = memberOf(object, key);
    if (!info) return u;
    const Value& texture = itemsOf(&c_.root, "textures")[size_t(indexIn(info, "index"))];
    const int source = indexIn(&texture, "source"), sampler = indexIn(&texture, "sampler");
    if (source < 0) {
      c_.warn(place_, std::string(key) + " names a texture without an image that can be read; it is ignored");
      return u;
    }
    // A model can be shown without an image.
    if (!c_.attempt([&] { u.texture = textureOf(size_t(source), kind == Kind::Color); },
                    place_ + " is shown without its " + key))
      return u;
    if (sampler >= 0) {
      const Value& s = itemsOf(&c_.root, "samplers")[size_t(sampler)];
      u.wrapU = wrapOf(indexIn(&s, "wrapS"));
      u.wrapV = wrapOf(indexIn(&s, "wrapT"));
      const int near = indexIn(&s, "magFilter");
      u.nearest = isNearest(near >= 0 ? near : indexIn(&s, "minFilter"));
    }
    double texCoord = numberOr(info, "texCoord", 0);
    if (const Value* transform = extensionOf(info, "KHR_texture_transform")) {
      const glm::mat3x2 wanted = textureTransform(transform);
      const float sum = glm::dot(wanted[0] + wanted[1] + wanted[2], glm::vec2(1));
      if (std::isfinite(finite(sum, sum, "KHR_texture_transform"))) u.transform = wanted;
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

  // Text of the uri of an image that lies in a file; empty if it does not.
  static std::string fileUri(const Value& image) {
    const std::string uri = textOr(&image, "uri", "");
    return isDataUri(uri) ? std::string() : uri;
  }

  std::string imageName(size_t index) const {
    const Value& image = images_[index];
    if (const std::string uri = fileUri(image); !uri.empty()) return uri.substr(0, 200);
    return textOr(&image, "name", "images[" + std::to_string(index) + "]");
  }

  std::string messageName(size_t index) const {
    return c_.source.name + ": " + nameOf("images", index, imageName(index));
  }

  // Images that name the same file or the same part of a buffer are decoded once.
  void findAlike() {
    std::map<std::pair<std::string, int>, size_t> first;
    for (size_t i = 0; i < images_.size(); ++i) {
      std::string file = fileUri(images_[i]);
      if (!file.empty()) file = resolveUri(c_.source, file).file.string();
      const int view = indexIn(&images_[i], "bufferView");
      const bool named = !file.empty() || view >= 0;
      firstAlike_.push_back(named ? first.emplace(std::pair(file, view), i).first->second : i);
    }
  }

  // Before anything is decoded, because a few bytes can claim to be a large picture.
  void claimMemory() {
    constexpr uint64_t kBytes = 8;  // a pixel, in the scene and on the device
    std::set<size_t> used;
    for (const Value& texture : itemsOf(&c_.root, "textures"))
      if (const int source = indexIn(&texture, "source"); source >= 0)
        used.insert(firstAlike_[size_t(source)]);
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
    const Value& image = images_[index];
    if (const int view = indexIn(&image, "bufferView"); view >= 0) return bytesOf(c_.model, view);
    const std::string uri = textOr(&image, "uri", "");
    if (uri.empty()) c_.fail(messageName(index), "the image cannot be read");
    if (isDataUri(uri)) {
      DataUri data = decodeDataUri(uri);
      if (!data.problem.empty()) c_.fail(messageName(index), data.problem);
      file_ = std::move(data.bytes);
      return file_;
    }
    const ResolvedUri r = resolveUri(c_.source, uri);
    if (!r.problem.empty()) c_.fail(messageName(index), r.problem, r.remedy);
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
  const std::vector<Value>& images_;
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
  for (size_t i = 0; i < itemsOf(&c.root, "materials").size(); ++i)
    c.scene.materials.push_back(builder.build(i));
}

}  // namespace fovea::scene::gltf
