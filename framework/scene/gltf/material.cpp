// Builds materials and textures. Decodes only the images that a diffuse surface needs: base
// colour, emission, metalness.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "fovea/image.h"
#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

double numberOr(const tinygltf::Value& object, const char* key, double fallback) {
  if (!object.IsObject() || !object.Has(key)) return fallback;
  const tinygltf::Value& v = object.Get(key);
  return v.IsNumber() ? v.GetNumberAsDouble() : fallback;
}

glm::vec2 pairOr(const tinygltf::Value& object, const char* key, glm::vec2 fallback) {
  if (!object.IsObject() || !object.Has(key)) return fallback;
  const tinygltf::Value& v = object.Get(key);
  if (!v.IsArray() || v.ArrayLen() != 2 || !v.Get(0).IsNumber() || !v.Get(1).IsNumber()) return fallback;
  return {float(v.Get(0).GetNumberAsDouble()), float(v.Get(1).GetNumberAsDouble())};
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
glm::mat3x2 textureTransform(const tinygltf::Value& t) {
  const glm::vec2 offset = pairOr(t, "offset", glm::vec2(0.0f)), scale = pairOr(t, "scale", glm::vec2(1.0f));
  const float angle = float(numberOr(t, "rotation", 0.0));
  const float c = std::cos(angle), s = std::sin(angle);
  return glm::mat3x2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
}

class MaterialBuilder {
 public:
  explicit MaterialBuilder(Context& c) : c_(c), textureOfImage_(c.model.images.size(), kNoIndex) {}

  Material build(size_t index) {
    const tinygltf::Material& from = c_.model.materials[index];
    place_ = nameOf("materials", index, from.name);
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    Material m;
    m.name = from.name.empty() ? "material " + std::to_string(index) : from.name;
    for (int i = 0; i < 4; ++i)
      m.baseColor[i] = unitValue(pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[size_t(i)] : 1.0,
                                 "baseColorFactor");
    m.metallic = metallicFactor(pbr, index);

    int colorSet = 0, emissionSet = 0;
    m.baseColorTexture = use(pbr.baseColorTexture, "baseColorTexture", colorSet);
    emission(from, m, emissionSet);
    if (m.baseColorTexture && m.emissionTexture && colorSet != emissionSet)
      c_.warn(place_,
              "emissiveTexture uses other texture coordinates than baseColorTexture; it is read with those "
              "of the latter");
    c_.texCoordOfMaterial.push_back(m.baseColorTexture ? colorSet : emissionSet);
    metalness(pbr, m);
    alpha(from, m);
    m.doubleSided = from.doubleSided;
    return m;
  }

 private:
  float unitValue(double v, const char* what) {
    if (v < -1e-4 || v > 1.0001)
      c_.warn(place_, std::string(what) + " " + std::to_string(v) + " lies outside 0..1 and is clamped");
    return float(std::clamp(v, 0.0, 1.0));
  }

  // The default in glTF is 1, a pure metal, which a diffuse renderer shows black. A file that never mentions metal
  // usually comes from an exporter that wrote no material rather than from one that meant a mirror.
  float metallicFactor(const tinygltf::PbrMetallicRoughness& pbr, size_t index) {
    const json::Value* written = c_.root.find("materials")->items[index].find("pbrMetallicRoughness");
    const bool said = written && (written->find("metallicFactor") || pbr.metallicRoughnessTexture.index >= 0);
    return said ? unitValue(pbr.metallicFactor, "metallicFactor") : 0.0f;
  }

  void emission(const tinygltf::Material& from, Material& m, int& set) {
    double strength = 1.0;
    const auto extension = from.extensions.find("KHR_materials_emissive_strength");
    if (extension != from.extensions.end()) strength = numberOr(extension->second, "emissiveStrength", 1.0);
    for (int i = 0; i < 3 && from.emissiveFactor.size() == 3; ++i)
      m.emission[i] = float(std::max(from.emissiveFactor[size_t(i)] * strength, 0.0));
    if (!std::isfinite(m.emission.x + m.emission.y + m.emission.z))
      c_.fail(place_, "the emission is not a finite number");
    if (m.emission != glm::vec3(0.0f)) m.emissionTexture = use(from.emissiveTexture, "emissiveTexture", set);
  }

  void alpha(const tinygltf::Material& from, Material& m) {
    m.alphaCutoff = float(from.alphaCutoff);
    m.masked = from.alphaMode == "MASK";
    if (from.alphaMode != "BLEND") return;
    c_.warn(place_, "alphaMode BLEND is drawn as MASK with a cutoff of 0.5");
    m.masked = true;
    m.alphaCutoff = 0.5f;
  }

  // One metalness per material: the mean of the texture's blue channel.
  void metalness(const tinygltf::PbrMetallicRoughness& pbr, Material& m) {
    const int texture = pbr.metallicRoughnessTexture.index;
    if (texture >= 0 && m.metallic > 0.0f && c_.model.textures[size_t(texture)].source >= 0) {
      const image::Image8 image = decode(size_t(c_.model.textures[size_t(texture)].source));
      uint64_t sum = 0;
      for (size_t i = 2; i < image.rgba.size(); i += 4) sum += image.rgba[i];
      m.metallic *= float(double(sum) / (255.0 * double(std::max<size_t>(image.rgba.size() / 4, 1))));
    }
    if (m.metallic > 0.99f && m.emission == glm::vec3(0.0f))
      c_.warn(place_, "a pure metal reflects nothing diffusely and is shown black",
              "set metallicFactor to 0");
  }

  TextureUse use(const tinygltf::TextureInfo& info, const char* what, int& set) {
    TextureUse u;
    if (info.index < 0) return u;
    set = info.texCoord;
    const tinygltf::Texture& texture = c_.model.textures[size_t(info.index)];
    if (texture.source < 0) {
      c_.warn(place_,
              std::string(what) + " names a texture without an image that can be read; it is ignored");
      return u;
    }
    u.texture = textureOf(size_t(texture.source));
    if (texture.sampler >= 0) {
      u.wrapU = wrapOf(c_.model.samplers[size_t(texture.sampler)].wrapS);
      u.wrapV = wrapOf(c_.model.samplers[size_t(texture.sampler)].wrapT);
    }
    const auto extension = info.extensions.find("KHR_texture_transform");
    if (extension == info.extensions.end()) return u;
    u.transform = textureTransform(extension->second);
    set = int(numberOr(extension->second, "texCoord", set));
    return u;
  }

  uint32_t textureOf(size_t image) {
    uint32_t& known = textureOfImage_[image];
    if (known != kNoIndex) return known;
    image::Image8 pixels = decode(image);
    Texture t;
    t.name = imageName(image);
    t.width = pixels.width;
    t.height = pixels.height;
    t.rgba = std::move(pixels.rgba);
    known = uint32_t(c_.scene.textures.size());
    c_.scene.textures.push_back(std::move(t));
    return known;
  }

  std::string imageName(size_t index) const {
    const tinygltf::Image& image = c_.model.images[index];
    if (!image.uri.empty() && !isDataUri(image.uri)) return image.uri.substr(0, 200);
    return image.name.empty() ? "images[" + std::to_string(index) + "]" : image.name;
  }

  image::Image8 decode(size_t index) {
    const tinygltf::Image& image = c_.model.images[index];
    const std::string name = c_.source.name + ": " + nameOf("images", index, imageName(index));
    std::vector<uint8_t> file;
    const std::vector<uint8_t>* bytes = &image.image;
    if (image.image.empty()) {
      const ResolvedUri r = resolveUri(c_.source.folder, image.uri);
      if (!r.problem.empty()) c_.fail(name, r.problem);
      std::error_code ec;
      if (!std::filesystem::exists(r.file, ec))
        throw Error(ExitCode::BadInput, name + ": the texture " + r.file.string() + " is missing",
                    "copy it beside the model, or remove it from the material");
      file = readFile(r.file);
      bytes = &file;
    }
    image::Image8 pixels = image::decode8(bytes->data(), bytes->size(), name);
    if (pixels.width == 0 || pixels.height == 0 || pixels.width > kMaxTextureSize ||
        pixels.height > kMaxTextureSize)
      c_.fail(name, "the texture has " + std::to_string(pixels.width) + " x " +
                        std::to_string(pixels.height) + " pixels; 1 to " + std::to_string(kMaxTextureSize) +
                        " a side can be used");
    return pixels;
  }

  Context& c_;
  std::vector<uint32_t> textureOfImage_;
  std::string place_;
};

}  // namespace

void buildMaterials(Context& c) {
  MaterialBuilder builder(c);
  for (size_t i = 0; i < c.model.materials.size(); ++i) c.scene.materials.push_back(builder.build(i));
}

}  // namespace fovea::scene::gltf
