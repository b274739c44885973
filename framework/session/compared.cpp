#include "framework/session/compared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <locale>
#include <sstream>

#include "fovea/error.h"
#include "framework/scene/fovea.h"
#include "framework/session/inputs.h"

namespace fovea::session {
namespace {

constexpr const char* kRadiance = "radiance";

[[noreturn]] void bad(const std::string& message, const std::string& remedy) {
  throw Error(ExitCode::BadInput, message, remedy);
}

struct Source {
  std::string name;
  image::File file;
  bool radiance = false;  // otherwise display values
};

Source open(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return {name, image::read(name), extension == ".exr" || extension == ".pfm"};
}

const image::Image* findLayer(const Source& source, const std::string& layer) {
  return source.file.find(layer);
}

// Throws for missing and unusable layers.
const image::Image& checked(const Source& source, const std::string& layer, const image::Image* found) {
  std::vector<std::string> names;
  for (const image::Layer& l : source.file.layers) names.push_back(l.name);
  if (!found)
    bad(fmt::format("`{}` has no layer `{}`; it has {}", source.name, layer, quoteList(names)),
        "choose one with --layer");
  const std::string name = "`" + source.name + "`" + (layer.empty() ? "" : ", layer `" + layer + "`,");
  image::checkComparable(*found, name, *found, name);
  return *found;
}

const image::Image& layerOf(const Source& source, const CompareOptions& options, std::string& layer) {
  if (source.file.layers.empty()) bad("`" + source.name + "` is empty", "render it again");
  if (!source.radiance || source.file.layers.size() == 1) {
    const image::Layer& only = source.file.layers.at(0);
    // The only layer of a file is used, whether it has a name or not.
    if (!options.layer.empty() && only.name != options.layer) return checked(source, options.layer, nullptr);
    return checked(source, layer = only.name, &only.image);
  }
  layer = options.layer.empty() ? kRadiance : options.layer;
  // A file of another program: a picture with further layers.
  if (options.layer.empty() && !findLayer(source, layer) && findLayer(source, "")) layer.clear();
  return checked(source, layer, findLayer(source, layer));
}

// ---- Metadata ----

// The comma-separated numbers of an entry; empty if there is no such entry.
std::vector<float> numbers(const Source& source, const std::string& key, size_t count) {
  const auto entry = source.file.metadata.find(key);
  if (entry == source.file.metadata.end()) return {};
  std::vector<float> values;
  std::istringstream text(entry->second);
  text.imbue(std::locale::classic());
  char comma = ',';
  for (float v = 0; comma == ',' && text >> v; text >> comma) values.push_back(v), comma = 0;
  const bool good = values.size() == count && text.eof() &&
                    std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
  if (!good)
    bad(fmt::format("`{}`: its metadata fovea.{} is `{}`", source.name, key, entry->second),
        "give --" + (key == "fovea_radius" ? "radius" : key));
  return values;
}

std::vector<float> numbersOfEither(const Source& image, const Source& reference, const std::string& key,
                                   size_t count) {
  const std::vector<float> own = numbers(image, key, count);
  return own.empty() ? numbers(reference, key, count) : own;
}

float exposureOf(const Source& image, const Source& reference, const CompareOptions& options) {
  if (options.exposure) return *options.exposure;
  const std::vector<float> a = numbers(image, "exposure", 1), b = numbers(reference, "exposure", 1);
  if (!a.empty() && !b.empty() && std::abs(a[0] - b[0]) > 1e-5f * std::abs(a[0]))
    bad(fmt::format("`{}` has exposure {} and `{}` has {}", image.name, a[0], reference.name, b[0]),
        "errors compare only at one exposure: give --exposure");
  const float exposure = !a.empty() ? a[0] : !b.empty() ? b[0] : 1;
  if (!(exposure > 0)) bad(fmt::format("`{}`: its exposure is {}", image.name, exposure), "give --exposure");
  return exposure;
}

void setFovea(Compared& compared, const Source& image, const Source& reference,
              const CompareOptions& options) {
  compared.gaze = glm::vec2(0.5f);
  compared.radius = float(kFoveaRadius);
  if (!options.gaze.empty()) {
    compared.gaze = parseGaze(options.gaze);
  } else if (const auto gaze = numbersOfEither(image, reference, "gaze", 2); !gaze.empty()) {
    compared.gaze = {gaze[0], gaze[1]};
  }
  if (options.radius) {
    compared.radius = *options.radius;
  } else if (const auto radius = numbersOfEither(image, reference, "fovea_radius", 1); !radius.empty()) {
    compared.radius = radius[0];
  }
  const scene::Fovea fovea = scene::makeFovea(compared.gaze, compared.size, compared.radius);
  compared.fovea = {fovea.centre.x, fovea.centre.y, fovea.radius};
}

void warnAboutScenes(const Source& image, const Source& reference) {
  const auto a = image.file.metadata.find("scene_hash"), b = reference.file.metadata.find("scene_hash");
  if (a == image.file.metadata.end() || b == reference.file.metadata.end() || a->second == b->second) return;
  Diagnostics messages;
  messages.warning({}, {}, fmt::format("`{}` and `{}` show different scenes", image.name, reference.name),
                   "compare pictures of one scene");
  printWarnings(messages);
}

// ---- Halves and floors ----

image::Image combined(const image::Image& a, const image::Image& b, float sign) {
  image::Image sum = image::toRgb(a);
  const image::Image other = image::toRgb(b);
  for (size_t i = 0; i < sum.data.size(); ++i) sum.data[i] += sign * other.data[i];
  return sum;
}

image::Picture toPicture(const Source& source, const image::Image& image, float exposure) {
  return source.radiance ? image::fromRadiance(image, exposure) : image::fromDisplay(image);
}

// `half_a` and `half_b` are halves of `radiance`. Minus `direct` they are halves of `indirect` with all the noise of
// the former, since in scenes without emissive surfaces and sky direct light has none.
std::optional<image::Halves> halvesInside(const Source& reference, const std::string& layer, float exposure) {
  const image::Image *a = findLayer(reference, "half_a"), *b = findLayer(reference, "half_b");
  if (!a && !b) return {};
  if (!a || !b)
    bad(fmt::format("`{}` has only one of the layers `half_a` and `half_b`", reference.name),
        "render it again");
  checked(reference, "half_a", a);
  checked(reference, "half_b", b);
  if (layer == kRadiance)
    return image::Halves{image::fromRadiance(*a, exposure), image::fromRadiance(*b, exposure)};
  const image::Image* direct = findLayer(reference, "direct");
  if (layer != "indirect" || !direct) return {};
  checked(reference, "direct", direct);
  return image::Halves{image::fromRadiance(combined(*a, *direct, -1), exposure),
                       image::fromRadiance(combined(*b, *direct, -1), exposure)};
}

std::optional<image::Halves> halvesOf(const Source& reference, const std::vector<std::string>& files,
                                      const CompareOptions& options, const std::string& layer,
                                      float exposure) {
  if (files.empty()) return halvesInside(reference, layer, exposure);
  image::Picture pictures[2];
  for (size_t i = 0; i < 2; ++i) {
    const Source half = open(files[i]);
    std::string found;
    pictures[i] = toPicture(half, layerOf(half, options, found), exposure);
  }
  return image::Halves{std::move(pictures[0]), std::move(pictures[1])};
}

std::optional<image::Picture> perfectIndirect(const Source& image, const Source& reference,
                                              const std::string& layer, float exposure) {
  const image::Image *own = findLayer(image, "direct"), *exact = findLayer(reference, "direct"),
                     *radiance = findLayer(reference, kRadiance);
  if (layer != kRadiance || !own || !exact || !radiance) return {};
  checked(image, "direct", own);
  checked(reference, "direct", exact);
  return image::fromRadiance(combined(combined(*radiance, *exact, -1), *own, 1), exposure);
}

Compared prepared(const Source& image, const Source& reference, const std::vector<std::string>& halves,
                  const CompareOptions& options) {
  Compared compared;
  std::string layer;
  const image::Image& shown = layerOf(image, options, compared.layer);
  const image::Image& wanted = layerOf(reference, options, layer);
  image::checkComparable(image::toRgb(shown), "`" + image.name + "`", image::toRgb(wanted),
                         "`" + reference.name + "`");
  warnAboutScenes(image, reference);
  compared.exposure = exposureOf(image, reference, options);
  compared.image = toPicture(image, shown, compared.exposure);
  compared.reference = toPicture(reference, wanted, compared.exposure);
  compared.size = {shown.width, shown.height};
  setFovea(compared, image, reference, options);
  compared.halves = halvesOf(reference, halves, options, layer, compared.exposure);
  compared.perfectIndirect = perfectIndirect(image, reference, layer, compared.exposure);
  return compared;
}

}  // namespace

Compared loadCompared(const std::string& imageName, const std::string& referenceName,
                      const std::vector<std::string>& halves, const CompareOptions& options) {
  return prepared(open(imageName), open(referenceName), halves, options);
}

Compared compareRadiance(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options) {
  return prepared({imageName, std::move(image), true}, {referenceName, std::move(reference), true}, {},
                  options);
}

nlohmann::ordered_json describe(const Compared& c) {
  return {{"layer", c.layer},
          {"exposure", c.exposure},
          {"gaze", {c.gaze.x, c.gaze.y}},
          {"fovea_radius", c.radius},
          {"size", {c.size.x, c.size.y}}};
}

std::string describeInWords(const Compared& c) {
  return fmt::format("{}exposure {:.6g}, fovea of {:.4g} image widths",
                     c.layer.empty() ? "" : "layer " + c.layer + ", ", c.exposure, c.radius);
}

std::string formatMeasure(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

}  // namespace fovea::session
