#include "framework/scene/export/mitsuba.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "framework/scene/export/files.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/lights.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

std::string triple(const glm::vec3& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

std::string rgb(const char* name, const glm::vec3& v) {
  return fmt::format("<rgb name=\"{}\" value=\"{}\"/>", name, triple(v));
}

// Mitsuba's cameras and spot lights look along +Z with +X to their left.
std::string toWorld(const glm::vec3& position, const glm::quat& orientation) {
  const glm::mat3 axes = glm::mat3_cast(orientation);
  const glm::vec3 left = -axes[0], up = axes[1], forward = -axes[2];
  std::string rows;
  for (int i = 0; i < 3; ++i) rows += fmt::format("{} {} {} {}  ", left[i], up[i], forward[i], position[i]);
  return "<transform name=\"to_world\"><matrix value=\"" + rows + "0 0 0 1\"/></transform>";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (uint8_t(c) < 0x20)
      out += ' ';
    else if (c == '-' && !out.empty() && out.back() == '-')
      out += '_';  // two dashes would end a comment
    else
      out += c;
  }
  return out;
}

// The triangles of one material of one object, as PLY requires them.
class PlyMesh {
 public:
  PlyMesh(const Geometry& geometry) : geometry_(geometry) {}

  // shift: along the vertex normals, m; turned: whether the other side is the front.
  void add(const Triangle& t, float shift, bool turned) {
    glm::vec3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = geometry_.positions[t.v[k]];
    const glm::vec3 face = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (face == glm::vec3(0)) return;
    // In some models normals contradict the winding; the winding decides.
    bool against = true;
    for (const uint32_t v : t.v) against = against && glm::dot(geometry_.normals[v], face) < 0;
    uint32_t indices[3];
    for (int k = 0; k < 3; ++k) indices[k] = vertex(t.v[k], against != turned, against ? -shift : shift);
    if (turned) std::swap(indices[1], indices[2]);
    faces_.push_back(3);
    faces_.append(reinterpret_cast<const char*>(indices), sizeof indices);
    ++faceCount_;
  }

  bool empty() const { return faceCount_ == 0; }

  std::string text() const {
    return fmt::format(
               "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
               "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float u\n"
               "property float v\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
               vertexCount_, faceCount_) +
           vertices_ + faces_;
  }

 private:
  uint32_t vertex(uint32_t v, bool negated, float shift) {
    const auto [entry, isNew] = known_.try_emplace(uint64_t(v) << 1 | uint64_t(negated), vertexCount_);
    if (!isNew) return entry->second;
    const glm::vec3 p = geometry_.positions[v] + shift * geometry_.normals[v];
    const glm::vec3 n = negated ? -geometry_.normals[v] : geometry_.normals[v];
    const float values[8] = {p.x, p.y, p.z, n.x, n.y, n.z, geometry_.uvs[v].x, geometry_.uvs[v].y};
    vertices_.append(reinterpret_cast<const char*>(values), sizeof values);
    return vertexCount_++;
  }

  const Geometry& geometry_;
  std::unordered_map<uint64_t, uint32_t> known_;
  std::string vertices_, faces_;
  uint32_t vertexCount_ = 0, faceCount_ = 0;
};

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
constexpr uint32_t kMinFalloff = 256, kMaxFalloff = 4096;  // pixels per side of a spot light's image

class MitsubaWriter {
 public:
  MitsubaWriter(const Scene& scene, fs::path folder, const MitsubaOptions& options, Diagnostics& warnings)
      : scene_(scene), folder_(std::move(folder)), options_(options), warnings_(warnings) {}

  fs::path run() {
    const std::string name = safeFileName(scene_.name);
    makeFolder(folder_ / "meshes");
    makeFolder(folder_ / "textures");
    place();
    header();
    camera();
    for (const Light& light : lightsAt(scene_, options_.time)) emitter(light);
    if (scene_.environment != glm::vec3(0)) {
      // Here it is only visible; as a `constant` emitter it would also light the scene.
      line("<!-- Where nothing is hit (alpha 0), the scene shows " + triple(scene_.environment) + ". -->");
      warn("environment",
           "the environment is only seen, it lights nothing: add it where the picture's alpha is 0");
    }
    for (uint32_t i = 0; i < scene_.materials.size(); ++i) material(i);
    shapes();
    xml_ += "</scene>\n";
    const fs::path file = folder_ / (name + ".xml");
    writeWholeFile(file, xml_);
    return file;
  }

 private:
  void line(const std::string& text) { xml_ += "  " + text + "\n"; }

  void warn(const std::string& path, const std::string& message) {
    warnings_.warning({scene_.name, 0, 0}, path, message);
  }

  void place() {
    geometry_ = flatten(scene_);
    // Frame 1 of a sequence with that interval between frames.
    const Frame frame = options_.time > 0
                            ? makeFrame(scene_, geometry_, options_.size, 1, 1, 1.0 / options_.time)
                            : makeFrame(scene_, geometry_, options_.size, 0, 1);
    moveObjects(frame, geometry_);
  }

  void header() {
    const bool masked = std::any_of(scene_.materials.begin(), scene_.materials.end(),
                                    [](const Material& m) { return m.masked; });
    xml_ = "<scene version=\"3.0.0\">\n";
    line("<!-- " + escaped(scene_.name) +
         fmt::format(", {} s. Lengths in m; point and spot lights in W/sr, ", options_.time) +
         "directional ones in W/m^2 a channel (cd and lux of the scene). -->");
    line(fmt::format("<default name=\"width\" value=\"{}\"/>", options_.size.x));
    line(fmt::format("<default name=\"height\" value=\"{}\"/>", options_.size.y));
    line(fmt::format("<default name=\"spp\" value=\"{}\"/>", options_.samples));
    line(fmt::format("<default name=\"depth\" value=\"{}\"/>", options_.depth));
    if (masked) {
      line(
          "<!-- volpath, not path: the latter casts shadows of masked surfaces as if they had no holes, and "
          "counts");
      line("     a hole as a bounce. Without media both are the same estimator otherwise. -->");
    }
    line(
        fmt::format("<integrator type=\"{}\"><integer name=\"max_depth\" value=\"$depth\"/>"
                    "<integer name=\"rr_depth\" value=\"1000\"/></integrator>",
                    masked ? "volpath" : "path"));
  }

  void camera() {
    const Camera c = cameraAt(scene_, options_.time);
    const float diagonal = geometry_.empty() ? 1 : glm::length(geometry_.boundsMax - geometry_.boundsMin);
    const glm::vec3 centre = 0.5f * (geometry_.boundsMin + geometry_.boundsMax);
    const float far = c.zFar > 0 ? c.zFar : glm::distance(c.position, centre) + diagonal;
    line("<sensor type=\"perspective\">");
    line("  <string name=\"fov_axis\" value=\"y\"/>");
    line(fmt::format("  <float name=\"fov\" value=\"{}\"/>", glm::degrees(double(c.verticalFov))));
    line(fmt::format("  <float name=\"near_clip\" value=\"{}\"/><float name=\"far_clip\" value=\"{}\"/>",
                     c.zNear, far));
    line("  " + toWorld(c.position, c.orientation));
    line("  <sampler type=\"independent\"><integer name=\"sample_count\" value=\"$spp\"/></sampler>");
    line(
        "  <film type=\"hdrfilm\"><integer name=\"width\" value=\"$width\"/>"
        "<integer name=\"height\" value=\"$height\"/>");
    line(
        "    <string name=\"pixel_format\" value=\"rgba\"/><string name=\"component_format\" "
        "value=\"float32\"/>");
    line("    <rfilter type=\"box\"/></film>");
    line("</sensor>");
  }

  // ---- Lights ----

  void emitter(const Light& light) {
    const glm::vec3 strength = light.color * light.intensity;
    if (light.range > 0 && light.type != LightType::Directional)
      warn("lights", "light `" + light.name + "` has a range; Mitsuba has none: it shines on without end");
    line("<!-- " + escaped(light.name) + " -->");
    if (light.type == LightType::Directional)
      line(fmt::format("<emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}</emitter>",
                       triple(light.direction), rgb("irradiance", strength)));
    else if (light.type == LightType::Point)
      line(fmt::format("<emitter type=\"point\"><point name=\"position\" value=\"{}\"/>{}</emitter>",
                       triple(light.position), rgb("intensity", strength)));
    else
      spot(light, strength);
  }

  // In Mitsuba a spot fades linearly in the angle. With its beam as wide as its cone it does not fade at all, and the
  // image that it projects provides the falloff: an image over the plane at distance 1 that holds saturate(..)^2.
  void spot(const Light& light, const glm::vec3& strength) {
    const SpotCone cone = spotCone(light);
    const float outer = std::acos(cone.cosOuter), inner = std::acos(std::min(cone.cosInner, 1.0f));
    constexpr float kWidest = 1.48f;  // 85 degrees; an image of a half-space would be infinite
    const float cutoff = std::min(outer, kWidest);
    if (cutoff < outer)
      warn("lights", "spot light `" + light.name + "` is wider than 85 degrees to a side: it ends there");
    const float edge = std::tan(cutoff), transition = edge - std::tan(std::min(inner, cutoff));
    // 64 texels from full light to none: bilinear look-ups are within 1e-4 of the falloff.
    const float wanted = transition > 0 ? 64 * 2 * edge / transition : float(kMaxFalloff);
    const uint32_t size = uint32_t(std::clamp(wanted, float(kMinFalloff), float(kMaxFalloff)));
    if (wanted > float(kMaxFalloff))
      warn("lights", "the edge of spot light `" + light.name + "` is thinner than its image can show");
    image::Image falloff{size, size, 1, std::vector<float>(size_t(size) * size)};
    for (uint32_t y = 0; y < size; ++y)
      for (uint32_t x = 0; x < size; ++x) {
        const glm::vec2 p = ((glm::vec2(x, y) + 0.5f) * (2.0f / float(size)) - 1.0f) * edge;
        const float cosine = 1.0f / std::sqrt(1.0f + glm::dot(p, p));
        const float s = std::clamp((cosine - cone.cosOuter) * cone.scale(), 0.0f, 1.0f);
        falloff.at(x, y, 0) = s * s;
      }
    const std::string file = "textures/" + names_.add("spot_" + safeFileName(light.name)) + ".exr";
    image::write(folder_ / file, {{"", std::move(falloff)}});
    const double degrees = glm::degrees(double(cutoff));
    line("<emitter type=\"spot\">" + rgb("intensity", strength));
    line(fmt::format("  <float name=\"cutoff_angle\" value=\"{}\"/><float name=\"beam_width\" value=\"{}\"/>",
                     degrees, degrees));
    line("  " + toWorld(light.position, lookAlong(light.direction, {0, 1, 0})));
    line("  <texture type=\"bitmap\" name=\"texture\"><string name=\"filename\" value=\"" + file +
         "\"/><boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" value=\"clamp\"/></texture>");
    line("</emitter>");
  }

  // ---- Materials ----

  bool textured(const TextureUse& use) const { return use && use.texture < scene_.textures.size(); }

  static std::string toUv(const TextureUse& use, const glm::vec2& scale) {
    const glm::mat3x2& m = use.transform;
    if (m == glm::mat3x2{1, 0, 0, 1, 0, 0} && scale == glm::vec2(1)) return {};
    // A 4x4 matrix, of which Mitsuba uses the first two rows and columns, with the translation in the last column.
    return fmt::format(
        "<transform name=\"to_uv\"><matrix value=\"{} {} 0 {}  {} {} 0 {}  0 0 1 0  0 0 0 1\"/></transform>",
        scale.x * m[0].x, scale.x * m[1].x, scale.x * m[2].x, scale.y * m[0].y, scale.y * m[1].y,
        scale.y * m[2].y);
  }

  std::string bitmap(const char* name, const std::string& file, bool raw, const char* filter,
                     const char* wrap, const std::string& transform) const {
    return fmt::format(
        "<texture type=\"bitmap\" name=\"{}\"><string name=\"filename\" value=\"{}\"/>"
        "<boolean name=\"raw\" value=\"{}\"/><string name=\"filter_type\" value=\"{}\"/>"
        "<string name=\"wrap_mode\" value=\"{}\"/>{}</texture>",
        name, file, raw, filter, wrap, transform);
  }

  std::string textureFile(const TextureUse& use, const std::string& suffix) {
    const std::string stem = fs::path(scene_.textures[use.texture].name).stem().string();
    return "textures/" + names_.add(safeFileName(stem.empty() ? "texture" : stem)) + suffix;
  }

  // A colour times a texture. On its own, an sRGB texture remains an 8-bit image, which Mitsuba decodes before it
  // filters; with a factor or linear texels it becomes an image of linear floats.
  std::string colour(const char* name, const TextureUse& use, const glm::vec3& factor) {
    if (!textured(use)) return rgb(name, factor);
    const Texture& source = scene_.textures[use.texture];
    const bool plain = factor == glm::vec3(1) && source.srgb;
    const Unfolded from = unfold(source, use.wrapU, use.wrapV);
    if (!from.exact)
      warn("materials", "texture `" + source.name + "` repeats in Mitsuba where it should end");
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
    return bitmap(name, file, !plain, "bilinear", from.wrap, toUv(use, from.scale));
  }

  // Whether bilinear alpha reaches the cutoff, at the middles of at least kMaskTexels^2 parts of each texel.
  std::string opacity(const Material& m) {
    const TextureUse& use = m.baseColorTexture;
    if (!textured(use))
      return fmt::format("<float name=\"opacity\" value=\"{}\"/>", m.baseColor.a >= m.alphaCutoff ? 1 : 0);
    const Texture& t = scene_.textures[use.texture];
    uint32_t parts = std::max(kMaskTexels, kMaskSide / std::max(t.width, t.height));
    while (parts > 1 && std::max(t.width, t.height) * parts > kMaxMaskSide) parts /= 2;
    // At its own place in the texture, so that the mask lies in one period and wraps as the texture does.
    const Unfolded from = unfold(t, use.wrapU, use.wrapV);
    const glm::uvec2 size = glm::uvec2(from.texture.width, from.texture.height) * parts;
    image::Image mask{size.x, size.y, 1, std::vector<float>(size_t(size.x) * size.y)};
    for (uint32_t y = 0; y < size.y; ++y)
      for (uint32_t x = 0; x < size.x; ++x) {
        const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / glm::vec2(size) / from.scale;
        mask.at(x, y, 0) = reflectance(scene_, m, straightUv(uv, use)).a >= m.alphaCutoff ? 1.0f : 0.0f;
      }
    const std::string file = textureFile(use, "_mask.png");
    image::write(folder_ / file, {{"", std::move(mask)}});
    return bitmap("opacity", file, true, "nearest", from.wrap, toUv(use, from.scale));
  }

  // The coordinates that the transform of `use` maps to `uv`.
  static glm::vec2 straightUv(const glm::vec2& uv, const TextureUse& use) {
    const glm::mat2 axes(use.transform[0], use.transform[1]);
    return glm::inverse(axes) * (uv - use.transform[2]);
  }

  void material(uint32_t index) {
    const Material& m = scene_.materials[index];
    line("<!-- " + escaped(m.name) + " -->");
    std::string bsdf =
        "<bsdf type=\"diffuse\">" +
        colour("reflectance", m.baseColorTexture, glm::vec3(m.baseColor) * (1.0f - m.metallic)) + "</bsdf>";
    if (m.doubleSided) bsdf = "<bsdf type=\"twosided\">" + bsdf + "</bsdf>";
    if (m.masked) bsdf = "<bsdf type=\"mask\">" + opacity(m) + bsdf + "</bsdf>";
    // The outermost one carries the name.
    bsdf.insert(bsdf.find('>'), fmt::format(" id=\"m{}\"", index));
    line(bsdf);
  }

  // ---- Shapes ----

  void shapes() {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> groups;  // object, material
    for (uint32_t i = 0; i < geometry_.triangles.size(); ++i)
      groups[{geometry_.triangles[i].object(), geometry_.triangles[i].material()}].push_back(i);
    const float diagonal = geometry_.empty() ? 1 : glm::length(geometry_.boundsMax - geometry_.boundsMin);
    for (const auto& [group, triangles] : groups) {
      const Material& m = scene_.materials[group.second];
      std::string emitter;
      if (m.emission != glm::vec3(0))
        emitter =
            "<emitter type=\"area\">" + colour("radiance", m.emissionTexture, m.emission) + "</emitter>";
      const bool twice = !emitter.empty() && m.doubleSided;  // Mitsuba's surfaces emit from their front only
      const float shift = twice ? 0.5e-5f * diagonal : 0.0f;
      for (int side = 0; side < (twice ? 2 : 1); ++side) {
        PlyMesh mesh(geometry_);
        for (const uint32_t t : triangles) mesh.add(geometry_.triangles[t], side ? -shift : shift, side != 0);
        if (!mesh.empty()) shape(mesh, group.first, group.second, emitter);
      }
    }
  }

  void shape(const PlyMesh& mesh, uint32_t object, uint32_t material, const std::string& emitter) {
    const std::string file =
        "meshes/" +
        names_.add(safeFileName(geometry_.objects[object].name + "_" + scene_.materials[material].name)) +
        ".ply";
    writeWholeFile(folder_ / file, mesh.text());
    line(
        fmt::format("<shape type=\"ply\"><string name=\"filename\" value=\"{}\"/><ref id=\"m{}\"/>{}</shape>",
                    file, material, emitter));
  }

  const Scene& scene_;
  fs::path folder_;
  MitsubaOptions options_;
  Diagnostics& warnings_;
  Geometry geometry_;
  std::string xml_;
  std::map<std::string, std::string> files_;  // files of textures, by their content
  UniqueNames names_{"_"};
};

}  // namespace

fs::path exportMitsuba(const Scene& scene, const fs::path& folder, const MitsubaOptions& options,
                       Diagnostics& warnings) {
  return MitsubaWriter(scene, folder, options, warnings).run();
}

}  // namespace fovea::scene
