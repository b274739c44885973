#include "framework/scene/export/mitsuba_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

// A texture converted to what Mitsuba can show: there, one wrap mode (repeat or clamp) holds for both axes.
struct Unfolded {
  Texture texture;
  const char* wrap = "repeat";
  glm::vec2 scale{1};  // of the coordinates
  bool exact = true;
};

Unfolded unfold(const Texture& t, Wrap u, Wrap v) {
  if (u == v)
    return {t, u == Wrap::Repeat ? "repeat" : u == Wrap::Clamp ? "clamp" : "mirror", glm::vec2(1), true};
  Unfolded out{t, "repeat", glm::vec2(1), u != Wrap::Clamp && v != Wrap::Clamp};
  Texture& to = out.texture;
  to.width = t.width * (u == Wrap::Mirror ? 2 : 1);
  to.height = t.height * (v == Wrap::Mirror ? 2 : 1);
  to.rgba.resize(size_t(to.width) * to.height * 4);
  for (uint32_t y = 0; y < to.height; ++y)
    for (uint32_t x = 0; x < to.width; ++x) {
      const uint32_t sx = x < t.width ? x : 2 * t.width - 1 - x, sy = y < t.height ? y : 2 * t.height - 1 - y;
      std::memcpy(&to.rgba[(size_t(y) * to.width + x) * 4], &t.rgba[(size_t(sy) * t.width + sx) * 4], 4);
    }
  out.scale = glm::vec2(float(t.width) / float(to.width), float(t.height) / float(to.height));
  return out;
}

constexpr uint32_t kMaskTexels = 4;   // texels of the mask image per side of a texel, at least
constexpr uint32_t kMaskSide = 1024;  // pixels; small textures get more texels, up to this side
constexpr uint32_t kMaxMaskSide = 8192;

std::string toUv(const TextureUse& use, const glm::vec2& scale) {
  const glm::mat3x2& m = use.transform;
  if (m == glm::mat3x2{1, 0, 0, 1, 0, 0} && scale == glm::vec2(1)) return {};
  // A 4x4 matrix, of which Mitsuba uses the first two rows and columns, with the translation in the last column.
  return fmt::format(
      "<transform name=\"to_uv\"><matrix value=\"{} {} 0 {}  {} {} 0 {}  0 0 1 0  0 0 0 1\"/></transform>",
      scale.x * m[0].x, scale.x * m[1].x, scale.x * m[2].x, scale.y * m[0].y, scale.y * m[1].y,
      scale.y * m[2].y);
}

std::string bitmap(const char* name, const std::string& file, bool raw, const char* filter, const char* wrap,
                   const std::string& transform) {
  return fmt::format(
      "<texture type=\"bitmap\" name=\"{}\"><string name=\"filename\" value=\"{}\"/>"
      "<boolean name=\"raw\" value=\"{}\"/><string name=\"filter_type\" value=\"{}\"/>"
      "<string name=\"wrap_mode\" value=\"{}\"/>{}</texture>",
      name, file, raw, filter, wrap, transform);
}

const char* filterOf(const TextureUse& use) { return use.nearest ? "nearest" : "bilinear"; }

// The coordinates that the transform of `use` maps to `uv`.
glm::vec2 straightUv(const glm::vec2& uv, const TextureUse& use) {
  const glm::mat2 axes(use.transform[0], use.transform[1]);
  return glm::inverse(axes) * (uv - use.transform[2]);
}

std::string number(const char* name, float value) {
  return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, value);
}

}  // namespace

std::string triple(const glm::vec3& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

std::string rgb(const char* name, const glm::vec3& v) {
  return fmt::format("<rgb name=\"{}\" value=\"{}\"/>", name, triple(v));
}

MitsubaMaterials::MitsubaMaterials(const Scene& scene, fs::path folder, bool full, UniqueNames& names,
                                   Diagnostics& warnings)
    : scene_(scene), folder_(std::move(folder)), full_(full), names_(names), warnings_(warnings) {}

void MitsubaMaterials::warn(const std::string& message) {
  warnings_.warning({scene_.name, 0, 0}, "materials", message);
}

std::string MitsubaMaterials::textureFile(const TextureUse& use, const std::string& suffix) {
  const std::string stem = fs::path(scene_.textures[use.texture].name).stem().string();
  return "textures/" + names_.add(safeFileName(stem.empty() ? "texture" : stem)) + suffix;
}

// A colour times a texture. On its own, an sRGB texture remains an 8-bit image, which Mitsuba decodes before it
// filters; with a factor or linear texels it becomes an image of linear floats.
std::string MitsubaMaterials::colour(const char* name, const TextureUse& use, const glm::vec3& factor) {
  if (!textured(use)) return rgb(name, factor);
  const Texture& source = scene_.textures[use.texture];
  const bool plain = factor == glm::vec3(1) && source.srgb;
  const Unfolded from = unfold(source, use.wrapU, use.wrapV);
  if (!from.exact) warn("texture `" + source.name + "` repeats in Mitsuba where it should end");
  // The same image with another transform needs no second file.
  const std::string key = fmt::format("{} {} {} {} {}", use.texture, int(use.wrapU), int(use.wrapV), plain,
                                      plain ? "" : triple(factor));
  std::string& file = files_[key];
  if (file.empty()) {
    file = textureFile(use, plain ? ".png" : ".exr");
    image::Image pixels = texelImage(from.texture, 3);
    if (!plain)
      for (size_t i = 0; i < pixels.data.size(); ++i)
        pixels.data[i] =
            factor[int(i % 3)] * (source.srgb ? image::srgbDecode(pixels.data[i]) : pixels.data[i]);
    image::write(folder_ / file, {{"", std::move(pixels)}});
  }
  return bitmap(name, file, !plain, filterOf(use), from.wrap, toUv(use, from.scale));
}

// One channel of a texture of data times a factor, as an image of floats.
std::string MitsubaMaterials::channel(const char* name, const TextureUse& use, uint32_t channel,
                                      float factor) {
  if (!textured(use)) return number(name, factor);
  const Unfolded from = unfold(scene_.textures[use.texture], use.wrapU, use.wrapV);
  std::string& file = files_[fmt::format("{} {} {} channel {} {}", use.texture, int(use.wrapU),
                                         int(use.wrapV), channel, factor)];
  if (file.empty()) {
    file = textureFile(use, "_data.exr");
    image::Image pixels{from.texture.width, from.texture.height, 1,
                        std::vector<float>(size_t(from.texture.width) * from.texture.height)};
    for (size_t i = 0; i < pixels.data.size(); ++i)
      pixels.data[i] = factor * float(from.texture.rgba[4 * i + channel]) / 255.0f;
    image::write(folder_ / file, {{"", std::move(pixels)}});
  }
  return bitmap(name, file, true, filterOf(use), from.wrap, toUv(use, from.scale));
}

// An image of a property that varies with the texture of the base colour, evaluated at the middles of at least
// kMaskTexels^2 parts of each texel. The image covers the texture once, so that it repeats as the texture does.
std::string MitsubaMaterials::baked(const char* name, const Material& m, const std::string& suffix,
                                    uint32_t channels, const std::function<glm::vec3(glm::vec2)>& valueAt) {
  const TextureUse& use = m.baseColorTexture;
  const Texture& t = scene_.textures[use.texture];
  // Shapes of several objects may have the same material.
  std::string& file = files_[fmt::format("material {} {}", &m - scene_.materials.data(), name)];
  uint32_t parts = std::max(kMaskTexels, kMaskSide / std::max(t.width, t.height));
  while (parts > 1 && std::max(t.width, t.height) * parts > kMaxMaskSide) parts /= 2;
  const Unfolded from = unfold(t, use.wrapU, use.wrapV);
  if (file.empty()) {
    const glm::uvec2 size = glm::uvec2(from.texture.width, from.texture.height) * parts;
    image::Image pixels{size.x, size.y, channels, std::vector<float>(size_t(size.x) * size.y * channels)};
    for (uint32_t y = 0; y < size.y; ++y)
      for (uint32_t x = 0; x < size.x; ++x) {
        const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / glm::vec2(size) / from.scale;
        const glm::vec3 value = valueAt(straightUv(uv, use));
        for (uint32_t c = 0; c < channels; ++c) pixels.at(x, y, c) = value[int(c)];
      }
    file = textureFile(use, suffix);
    image::write(folder_ / file, {{"", std::move(pixels)}});
  }
  return bitmap(name, file, true, "nearest", from.wrap, toUv(use, from.scale));
}

// Whether bilinear alpha reaches the cutoff, or with alphaMode BLEND that alpha itself.
std::string MitsubaMaterials::opacity(const Material& m) {
  const auto opacityAt = [&](glm::vec2 uv) { return coverage(scene_, m, uv, 1, full_); };
  if (!textured(m.baseColorTexture)) return number("opacity", opacityAt({}));
  return baked("opacity", m, "_mask.png", 1, [&](glm::vec2 uv) { return glm::vec3(opacityAt(uv)); });
}

// Mitsuba shows the light of an emitter whatever the opacity of its surface, so its radiance contains that.
std::string MitsubaMaterials::radiance(const Material& m) {
  if (!m.masked) return colour("radiance", m.emissionTexture, m.emission);
  if (!textured(m.baseColorTexture))
    return colour("radiance", m.emissionTexture, m.emission * coverage(scene_, m, {}, 1, full_));
  if (textured(m.emissionTexture) && m.emissionTexture.transform != m.baseColorTexture.transform)
    warn("material `" + m.name +
         "` has its emissive texture in another place than its alpha, and in Mitsuba it " +
         "repeats with the latter");
  return baked("radiance", m, "_radiance.exr", 3,
               [&](glm::vec2 uv) { return emission(scene_, m, uv) * coverage(scene_, m, uv, 1, full_); });
}

std::string MitsubaMaterials::bsdf(uint32_t index) {
  const Material& m = scene_.materials[index];
  std::string bsdf = full_ ? fullBsdf(m)
                           : "<bsdf type=\"diffuse\">" +
                                 colour("reflectance", m.baseColorTexture,
                                        glm::vec3(m.baseColor) * (1.0f - m.meanMetallic())) +
                                 "</bsdf>";
  if (m.doubleSided) bsdf = "<bsdf type=\"twosided\">" + bsdf + "</bsdf>";
  if (m.masked) bsdf = "<bsdf type=\"mask\">" + opacity(m) + bsdf + "</bsdf>";
  // The outermost one carries the name.
  bsdf.insert(bsdf.find('>'), fmt::format(" id=\"m{}\"", index));
  return bsdf;
}

// ---- Full materials --------------------------------------------------------------------------------------------

std::string MitsubaMaterials::fullBsdf(const Material& m) {
  std::string missing;
  const auto lacks = [&](bool there, const char* what) {
    if (there) missing += (missing.empty() ? "" : ", ") + std::string(what);
  };
  lacks(m.transmission > 0, "transmission");
  lacks(m.clearcoat > 0, "clearcoat");
  lacks(m.unlit, "unlit");
  lacks(m.specular != 1 || m.specularTexture || m.specularColor != glm::vec3(1) || m.specularColorTexture,
        "specular");
  lacks(m.ior < 1.001f, "ior");
  bool second = false;
  for (const auto use : kMaterialTextures) second = second || (m.*use).set != 0;
  lacks(second, "the second texture coordinates");
  if (!missing.empty()) warn("material `" + m.name + "` is written without " + missing);

  const bool varies = textured(m.metallicRoughnessTexture) && m.metallic > 0;
  std::string inner;
  if (varies || (m.metallic > 0 && m.metallic < 1))
    inner = "<bsdf type=\"blendbsdf\">" + channel("weight", m.metallicRoughnessTexture, 2, m.metallic) +
            dielectric(m) + metal(m) + "</bsdf>";
  else
    inner = m.metallic > 0 ? metal(m) : dielectric(m);
  return withNormalMap(m, inner);
}

// The diffuse layer of a smooth `plastic` and the surface of a `roughplastic`, each counted twice and mixed in halves:
// their sum. The layer of `roughplastic` itself loses a third of its light at roughness 0.6 (Mitsuba 3.9). Its alpha is
// one number.
std::string MitsubaMaterials::dielectric(const Material& m) {
  if (m.ior < 1.001f)  // the surface reflects nothing
    return "<bsdf type=\"diffuse\">" + colour("reflectance", m.baseColorTexture, glm::vec3(m.baseColor)) +
           "</bsdf>";
  const float roughness = meanRoughness(m);
  const std::string iors = number("int_ior", m.ior) + number("ext_ior", 1);
  return "<bsdf type=\"blendbsdf\">" + number("weight", 0.5f) + "<bsdf type=\"plastic\">" + iors +
         number("specular_reflectance", 0) + twice("diffuse_reflectance", m) +
         "</bsdf><bsdf type=\"roughplastic\">" + "<string name=\"distribution\" value=\"ggx\"/>" +
         number("alpha", std::max(roughness * roughness, 1e-3f)) + iors + number("diffuse_reflectance", 0) +
         number("specular_reflectance", 2) + "</bsdf></bsdf>";
}

// Twice the base colour. Only images may be brighter than 1.
std::string MitsubaMaterials::twice(const char* name, const Material& m) {
  const glm::vec3 factor = 2.0f * glm::vec3(m.baseColor);
  if (textured(m.baseColorTexture)) return colour(name, m.baseColorTexture, factor);
  std::string& file = files_["colour " + triple(factor)];
  if (file.empty()) {
    file = "textures/" + names_.add(safeFileName(m.name)) + "_colour.exr";
    image::write(folder_ / file, {{"", image::Image{1, 1, 3, {factor.r, factor.g, factor.b}}}});
  }
  return bitmap(name, file, true, "nearest", "repeat", "");
}

std::string MitsubaMaterials::metal(const Material& m) {
  return "<bsdf type=\"principled\">" + colour("base_color", m.baseColorTexture, glm::vec3(m.baseColor)) +
         number("metallic", 1) + channel("roughness", m.metallicRoughnessTexture, 1, m.roughness) + "</bsdf>";
}

float MitsubaMaterials::meanRoughness(const Material& m) const {
  if (!textured(m.metallicRoughnessTexture)) return m.roughness;
  const std::vector<uint8_t>& rgba = scene_.textures[m.metallicRoughnessTexture.texture].rgba;
  double sum = 0;
  for (size_t i = 1; i < rgba.size(); i += 4) sum += rgba[i];
  return m.roughness * float(sum / (255.0 * double(std::max<size_t>(rgba.size() / 4, 1))));
}

// The image contains the scale. It is an affine function of the texels, so that interpolation commutes with it.
std::string MitsubaMaterials::withNormalMap(const Material& m, const std::string& inner) {
  const TextureUse& use = m.normalTexture;
  if (!textured(use)) return inner;
  const Unfolded from = unfold(scene_.textures[use.texture], use.wrapU, use.wrapV);
  image::Image pixels = texelImage(from.texture, 3);
  for (size_t i = 0; i < pixels.data.size(); ++i)
    if (i % 3 != 2) pixels.data[i] = 0.5f + m.normalScale * (pixels.data[i] - 0.5f);
  const std::string file = textureFile(use, "_normals.exr");
  image::write(folder_ / file, {{"", std::move(pixels)}});
  return "<bsdf type=\"normalmap\">" +
         bitmap("normalmap", file, true, filterOf(use), from.wrap, toUv(use, from.scale)) + inner + "</bsdf>";
}

}  // namespace fovea::scene
