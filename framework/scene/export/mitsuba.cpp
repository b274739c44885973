#include "framework/scene/export/mitsuba.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "fovea/image.h"
#include "framework/base/text_file.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/export/files.h"
#include "framework/scene/export/mitsuba_materials.h"
#include "framework/scene/file/scene_file.h"
#include "framework/scene/lights.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace fs = std::filesystem;
namespace {

// Mitsuba's cameras and spot lights look along +Z with +X to their left.
std::string toWorld(const glm::vec3& position, const glm::quat& orientation, const std::string& origin) {
  const glm::mat3 axes = glm::mat3_cast(orientation);
  const glm::vec3 left = -axes[0], up = axes[1], forward = -axes[2];
  std::string rows;
  for (int i = 0; i < 3; ++i) rows += fmt::format("{} {} {} {}  ", left[i], up[i], forward[i], position[i]);
  return "<transform name=\"to_world\"><matrix value=\"" + rows + "0 0 0 1\"/>" + origin + "</transform>";
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

constexpr uint32_t kMinFalloff = 256, kMaxFalloff = 4096;  // pixels per side of a spot light's image

class MitsubaWriter {
 public:
  MitsubaWriter(const Scene& scene, fs::path folder, const MitsubaOptions& options, Diagnostics& warnings)
      : scene_(scene),
        folder_(std::move(folder)),
        options_(options),
        warnings_(warnings),
        materials_(scene, folder_, options.full, names_, warnings) {}

  fs::path run() {
    const std::string name = safeFileName(scene_.name);
    makeFolder(folder_ / "meshes");
    makeFolder(folder_ / "textures");
    place();
    header();
    camera();
    for (const Light& light : lightsAt(scene_, options_.time)) emitter(light);
    if (scene_.environmentMap) {
      environmentMap(*scene_.environmentMap);
    } else if (scene_.environment != glm::vec3(0)) {
      // Here it is only visible; as a `constant` emitter it would also light the scene.
      line("<!-- Where nothing is hit (alpha 0), the scene shows " + triple(scene_.environment) + ". -->");
      warn("environment",
           "the environment is only seen, it lights nothing: add it where the picture's alpha is 0");
    }
    for (uint32_t i = 0; i < scene_.materials.size(); ++i) {
      line("<!-- " + escaped(scene_.materials[i].name) + " -->");
      line(materials_.bsdf(i));
    }
    shapes();
    xml_ += "</scene>\n";
    const fs::path file = folder_ / (name + ".xml");
    writeText(file, xml_);
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

  // Mitsuba sees the middle of the picture along +Z.
  void environmentMap(const EnvironmentMap& map) {
    writeEnvironment(folder_ / "environment.exr", map);
    line("<emitter type=\"envmap\">");
    line("  <string name=\"filename\" value=\"environment.exr\"/>");
    line(fmt::format("  <transform name=\"to_world\"><rotate y=\"1\" angle=\"{}\"/></transform>",
                     180 + glm::degrees(double(map.turn()))));
    line("</emitter>");
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
    origin();
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

  // Mitsuba's usual variants have single precision, in which such a scene can only be rendered near 0.
  void origin() {
    const glm::dvec3& o = scene_.origin;
    if (o == glm::dvec3(0)) return;
    line(
        "<!-- The origin of all coordinates below. Set it to 0, 0, 0 (-Dx=0 -Dy=0 -Dz=0) for variants with "
        "single");
    line("     precision; the picture stays the same. -->");
    for (int axis = 0; axis < 3; ++axis)
      line(fmt::format("<default name=\"{}\" value=\"{}\"/>", "xyz"[axis], o[axis]));
    origin_ = "<translate x=\"$x\" y=\"$y\" z=\"$z\"/>";
    warn("origin",
         "the scene lies so far from 0 that Mitsuba needs a variant with double precision, or the parameters "
         "x, y and z set to 0");
  }

  void camera() {
    const Camera c = cameraAt(scene_, options_.time);
    const float diagonal = geometry_.empty() ? 1 : glm::length(geometry_.boundsMax - geometry_.boundsMin);
    const glm::vec3 centre = 0.5f * (geometry_.boundsMin + geometry_.boundsMax);
    const float far = c.zFar > 0 ? c.zFar : glm::distance(c.position, centre) + diagonal;
    // A picture that is narrower than the author's shows both sides of it.
    const bool narrow = c.aspectRatio * float(options_.size.y) > float(options_.size.x);
    const double slope = std::tan(0.5 * double(c.verticalFov));
    const double degrees = narrow ? glm::degrees(2 * std::atan(slope * double(c.aspectRatio)))
                                  : glm::degrees(double(c.verticalFov));
    line("<sensor type=\"perspective\">");
    line(fmt::format("  <string name=\"fov_axis\" value=\"{}\"/>", narrow ? "x" : "y"));
    line(fmt::format("  <float name=\"fov\" value=\"{}\"/>", degrees));
    line(fmt::format("  <float name=\"near_clip\" value=\"{}\"/><float name=\"far_clip\" value=\"{}\"/>",
                     c.zNear, far));
    line("  " + toWorld(c.position, c.orientation, origin_));
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
      warn("lights",
           "light `" + light.name + "` has a range, which Mitsuba does not support: there it is unlimited");
    line("<!-- " + escaped(light.name) + " -->");
    if (light.type == LightType::Directional)
      line(fmt::format("<emitter type=\"directional\"><vector name=\"direction\" value=\"{}\"/>{}</emitter>",
                       triple(light.direction), rgb("irradiance", strength)));
    else if (light.type == LightType::Point)
      line("<emitter type=\"point\">" + pointAt(light.position) + rgb("intensity", strength) + "</emitter>");
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
    line("  " + toWorld(light.position, lookAlong(light.direction, {0, 1, 0}), origin_));
    line("  <texture type=\"bitmap\" name=\"texture\"><string name=\"filename\" value=\"" + file +
         "\"/><boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" value=\"clamp\"/></texture>");
    line("</emitter>");
  }

  std::string pointAt(const glm::vec3& p) const {
    if (origin_.empty()) return "<point name=\"position\" value=\"" + triple(p) + "\"/>";
    return fmt::format("<transform name=\"to_world\"><translate x=\"{}\" y=\"{}\" z=\"{}\"/>{}</transform>",
                       p.x, p.y, p.z, origin_);
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
        emitter = "<emitter type=\"area\">" + materials_.radiance(m) + "</emitter>";
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
    writeText(folder_ / file, mesh.text());
    line(fmt::format(
        "<shape type=\"ply\"><string name=\"filename\" value=\"{}\"/><ref id=\"m{}\"/>{}{}</shape>", file,
        material, emitter,
        origin_.empty() ? "" : "<transform name=\"to_world\">" + origin_ + "</transform>"));
  }

  const Scene& scene_;
  fs::path folder_;
  MitsubaOptions options_;
  Diagnostics& warnings_;
  Geometry geometry_;
  std::string xml_;
  std::string origin_;  // the part of a transform that moves to it; "" if it is 0
  UniqueNames names_{"_"};
  MitsubaMaterials materials_;
};

}  // namespace

fs::path exportMitsuba(const Scene& scene, const fs::path& folder, const MitsubaOptions& options,
                       Diagnostics& warnings) {
  return MitsubaWriter(scene, folder, options, warnings).run();
}

}  // namespace fovea::scene
