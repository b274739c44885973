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

constexpr const char *kRadiance = "radiance", *kCorrespondence = "correspondence";
constexpr const char* kRight = "_right";  // suffix of the layers of the right eye

[[noreturn]] void bad(const std::string& message, const std::string& remedy) {
  throw Error(ExitCode::BadInput, message, remedy);
}

struct Source {
  std::string name;
  image::File file;
};

Source open(const std::string& name) { return {name, image::read(name)}; }

std::vector<std::string> layerNames(const Source& source) {
  std::vector<std::string> names;
  for (const image::Layer& l : source.file.layers) names.push_back(l.name);
  return names;
}

std::string nameOf(const Source& source, const std::string& layer) {
  return "`" + source.name + "`" + (layer.empty() ? "" : ", layer `" + layer + "`,");
}

[[noreturn]] void noLayer(const Source& source, const std::string& layer) {
  for (const image::Unread& u : source.file.unread)
    if (u.name == layer)
      bad(fmt::format("`{}`: `{}` cannot be compared: {}", source.name, layer, u.reason),
          "choose another layer with --layer: the file has " + quoteList(layerNames(source)));
  bad(fmt::format("`{}` has no layer `{}`; it has {}", source.name, layer, quoteList(layerNames(source))),
      "choose one with --layer");
}

const image::Layer& layerOf(const Source& source, const CompareOptions& options, std::string& layer) {
  if (source.file.layers.empty()) bad("`" + source.name + "` is empty", "render it again");
  if (!source.file.radiance || source.file.layers.size() == 1) {
    const image::Layer& only = source.file.layers.at(0);
    // The only layer of a file is used, whether it has a name or not.
    if (!options.layer.empty() && only.name != options.layer) noLayer(source, options.layer);
    layer = only.name;
    return only;
  }
  layer = options.layer.empty() ? kRadiance : options.layer;
  // A file of another program: a picture with further layers.
  if (options.layer.empty() && !source.file.findLayer(layer) && source.file.findLayer("")) layer.clear();
  const image::Layer* found = source.file.findLayer(layer);
  if (!found) noLayer(source, layer);
  return *found;
}

void warn(const std::string& message, const std::string& remedy) {
  Diagnostics messages;
  messages.warning({}, {}, message, remedy);
  printWarnings(messages);
}

// ---- Where the pixels are ----

image::Window dataOf(const image::Layer& l) {
  return l.data.width > 0 ? l.data : image::Window{0, 0, l.image.width, l.image.height};
}
image::Window displayOf(const image::Layer& l) {
  return l.display.width > 0 ? l.display : image::Window{0, 0, l.image.width, l.image.height};
}

image::Window common(const image::Window& a, const image::Window& b) {
  const auto end = [](int32_t at, uint32_t size) { return int64_t(at) + size; };
  const int32_t x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int64_t right = std::min(end(a.x, a.width), end(b.x, b.width));
  const int64_t bottom = std::min(end(a.y, a.height), end(b.y, b.height));
  return {x, y, uint32_t(std::max<int64_t>(right - x, 0)), uint32_t(std::max<int64_t>(bottom - y, 0))};
}

std::string windowText(const image::Window& w) {
  const std::string size = fmt::format("{}x{}", w.width, w.height);
  return w.x == 0 && w.y == 0 ? size : fmt::format("{} from {}, {}", size, w.x, w.y);
}

// The pixels of the displayed picture that both layers hold.
image::Window overlap(const image::Layer& image, const std::string& name, const image::Layer& reference,
                      const std::string& referenceName) {
  const image::Window display = displayOf(image), other = displayOf(reference);
  if (display != other)
    bad(fmt::format("`{}` and `{}` differ in size: {} and {}", name, referenceName, windowText(display),
                    windowText(other)),
        "render both with the same --size, or cut them to the same display window");
  const image::Window both = common(common(dataOf(image), dataOf(reference)), display);
  if (both.width == 0 || both.height == 0)
    bad(fmt::format(
            "`{}` holds the pixels {} and `{}` the pixels {} of a picture of {}, which have none in common",
            name, windowText(dataOf(image)), referenceName, windowText(dataOf(reference)),
            windowText(display)),
        "compare pictures of the same part");
  if (both != display)
    warn(fmt::format(
             "only the pixels {} of a picture of {} are compared, because `{}` holds {} and `{}` holds {}",
             windowText(both), windowText(display), name, windowText(dataOf(image)), referenceName,
             windowText(dataOf(reference))),
         "");
  return both;
}

// The positions in `names` of the channels that are colours: R, G and B, or else all of one or three. Empty if there
// are none.
std::vector<size_t> colours(const std::vector<std::string>& names) {
  const auto upper = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return text;
  };
  const auto find = [&](const char* name) {
    const auto same = [&](const std::string& other) { return upper(other) == name; };
    return size_t(std::find_if(names.begin(), names.end(), same) - names.begin());
  };
  const size_t r = find("R"), g = find("G"), b = find("B"), y = find("Y");
  if (std::max({r, g, b}) < names.size()) return {r, g, b};
  if (names.size() == 1 || (names.size() == 2 && y < 2 && find("A") < 2)) return {y < names.size() ? y : 0};
  if (names.size() == 3) return {0, 1, 2};
  return {};
}

// The colours of the pixels in the window, which the layer must hold; three channels, or one of grey.
image::Image cut(const Source& source, const image::Layer& layer, const image::Window& window) {
  const image::Image& all = layer.image;
  const image::Window data = dataOf(layer);
  const std::string name = nameOf(source, layer.name);
  if (common(data, window) != window)
    bad(fmt::format("{} holds the pixels {} and not all of {}", name, windowText(data), windowText(window)),
        "render it again");
  static const std::vector<std::string> kUsual[] = {
      {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  const std::vector<std::string>& names =
      layer.channels.empty() ? kUsual[std::min<size_t>(all.channels, 4)] : layer.channels;
  const std::vector<size_t> used = colours(names);
  if (used.empty())
    bad(fmt::format("{} has the channels {}, which are no colours", name, quoteList(names)),
        "choose a layer of R, G and B or of one channel with --layer: the file has " +
            quoteList(layerNames(source)));
  image::Image part{window.width, window.height, uint32_t(used.size()), {}};
  part.data.reserve(image::pixelCount(part) * used.size());
  for (uint32_t y = 0; y < window.height; ++y)
    for (uint32_t x = 0; x < window.width; ++x)
      for (const size_t c : used)
        part.data.push_back(
            all.at(uint32_t(window.x - data.x) + x, uint32_t(window.y - data.y) + y, uint32_t(c)));
  image::checkComparable(part, name, part, name);
  return part;
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
  const image::Window &all = compared.display, &window = compared.window;
  const scene::Fovea fovea = scene::makeFovea(compared.gaze, {all.width, all.height}, compared.radius);
  compared.fovea = {fovea.centre.x - float(window.x - all.x), fovea.centre.y - float(window.y - all.y),
                    fovea.radius};
}

void warnAboutScenes(const Source& image, const Source& reference) {
  const auto a = image.file.metadata.find("scene_hash"), b = reference.file.metadata.find("scene_hash");
  if (a == image.file.metadata.end() || b == reference.file.metadata.end() || a->second == b->second) return;
  warn(fmt::format("`{}` and `{}` show different scenes", image.name, reference.name),
       "compare pictures of one scene");
}

void warnAboutLayers(const Source& image, const image::Layer& shown, const Source& reference,
                     const image::Layer& wanted) {
  if (!shown.name.empty() && !wanted.name.empty() && shown.name != wanted.name)
    warn(fmt::format("the layer `{}` of `{}` is compared with the layer `{}` of `{}`", shown.name, image.name,
                     wanted.name, reference.name),
         "");
  for (const auto& [source, layer] : {std::pair{&image, &shown}, {&reference, &wanted}}) {
    std::vector<std::string> left;
    const std::vector<size_t> used = colours(layer->channels);
    for (size_t c = 0; c < layer->channels.size(); ++c)
      if (std::find(used.begin(), used.end(), c) == used.end() && layer->channels[c] != "A")
        left.push_back(layer->channels[c]);
    if (!used.empty() && !left.empty())
      warn(fmt::format("{} has channels besides its colours that are not compared: {}",
                       nameOf(*source, layer->name), quoteList(left)),
           "");
  }
}

void warnAboutGrey(const Source& image, const image::Image& shown, const Source& reference,
                   const image::Image& wanted) {
  if (shown.channels == wanted.channels) return;
  const std::string& grey = shown.channels == 1 ? image.name : reference.name;
  warn(fmt::format("`{}` is grey, and is compared with each of red, green and blue", grey), "");
}

// ---- Halves and floors ----

image::Image combined(const image::Image& a, const image::Image& b, float sign) {
  image::Image sum = image::toRgb(a);
  const image::Image other = image::toRgb(b);
  for (size_t i = 0; i < sum.data.size(); ++i) sum.data[i] += sign * other.data[i];
  return sum;
}

image::Picture toPicture(const Source& source, const image::Image& image, float exposure) {
  return source.file.radiance ? image::fromRadiance(image, exposure) : image::fromDisplay(image);
}

// `half_a` and `half_b` are halves of `radiance`. Minus `direct` they are halves of `indirect` with all the noise of
// the former, since in scenes without emissive surfaces and sky direct light has none. Layers of the right eye have
// halves of their own.
std::optional<image::Halves> halvesInside(const Source& reference, const std::string& layer,
                                          const image::Window& window, float exposure) {
  const std::string eye = layer.ends_with(kRight) ? kRight : "";
  const image::Layer *a = reference.file.findLayer("half_a" + eye),
                     *b = reference.file.findLayer("half_b" + eye);
  if (!a && !b) return {};
  if (!a || !b)
    bad(fmt::format("`{0}` has only one of the layers `half_a{1}` and `half_b{1}`", reference.name, eye),
        "render it again");
  const image::Image first = cut(reference, *a, window), second = cut(reference, *b, window);
  if (layer == kRadiance + eye)
    return image::Halves{image::fromRadiance(first, exposure), image::fromRadiance(second, exposure)};
  const image::Layer* direct = reference.file.findLayer("direct" + eye);
  if (layer != "indirect" + eye || !direct) return {};
  const image::Image known = cut(reference, *direct, window);
  return image::Halves{image::fromRadiance(combined(first, known, -1), exposure),
                       image::fromRadiance(combined(second, known, -1), exposure)};
}

// The display window is that of the reference.
std::optional<image::Halves> halvesOf(const Source& reference, const std::vector<std::string>& files,
                                      const CompareOptions& options, const std::string& layer,
                                      const image::Window& display, const image::Window& window,
                                      float exposure) {
  if (files.empty()) return halvesInside(reference, layer, window, exposure);
  image::Picture pictures[2];
  for (size_t i = 0; i < 2; ++i) {
    const Source half = open(files[i]);
    std::string found;
    const image::Layer& own = layerOf(half, options, found);
    if (displayOf(own) != display)
      bad(fmt::format("the half `{}` and its reference `{}` differ in size: {} and {}", half.name,
                      reference.name, windowText(displayOf(own)), windowText(display)),
          "render both with the same --size");
    pictures[i] = toPicture(half, cut(half, own, window), exposure);
  }
  return image::Halves{std::move(pictures[0]), std::move(pictures[1])};
}

std::optional<image::Picture> perfectIndirect(const Source& image, const Source& reference,
                                              const std::string& layer, const image::Window& window,
                                              float exposure) {
  const image::Layer *own = image.file.findLayer("direct"), *exact = reference.file.findLayer("direct"),
                     *radiance = reference.file.findLayer(kRadiance);
  if (layer != kRadiance || !own || !exact || !radiance) return {};
  return image::fromRadiance(
      combined(combined(cut(reference, *radiance, window), cut(reference, *exact, window), -1),
               cut(image, *own, window), 1),
      exposure);
}

Compared preparedLayer(const Source& image, const Source& reference, const std::vector<std::string>& halves,
                       const CompareOptions& options) {
  Compared compared;
  std::string layer;
  const image::Layer& shown = layerOf(image, options, compared.layer);
  const image::Layer& wanted = layerOf(reference, options, layer);
  const image::Window window = overlap(shown, image.name, wanted, reference.name);
  const image::Image own = cut(image, shown, window), exact = cut(reference, wanted, window);
  warnAboutLayers(image, shown, reference, wanted);
  warnAboutGrey(image, own, reference, exact);
  compared.exposure = exposureOf(image, reference, options);
  compared.image = toPicture(image, own, compared.exposure);
  compared.reference = toPicture(reference, exact, compared.exposure);
  compared.display = displayOf(shown);
  compared.window = window;
  setFovea(compared, image, reference, options);
  compared.halves = halvesOf(reference, halves, options, layer, compared.display, window, compared.exposure);
  compared.perfectIndirect = perfectIndirect(image, reference, layer, window, compared.exposure);
  return compared;
}

Compared prepared(const Source& image, const Source& reference, const std::vector<std::string>& halves,
                  const CompareOptions& options) {
  warnAboutScenes(image, reference);
  return preparedLayer(image, reference, halves, options);
}

// ---- Both eyes ----

void checkEyes(const Source& source, const std::string& layer, const std::string& graph) {
  std::vector<std::string> names = layerNames(source);
  std::erase(names, "");
  for (const std::string& eye : {layer, layer + kRight})
    if (!source.file.findLayer(eye))
      bad(fmt::format("`{}` has no layer `{}` and cannot be compared with --eyes; it has {}", source.name,
                      eye, names.empty() ? "one picture alone" : quoteList(names)),
          fmt::format("render {} to an .exr file", graph));
}

ComparedEyes preparedEyes(const Source& image, const Source& reference, CompareOptions options) {
  if (options.layer.empty()) options.layer = kRadiance;
  checkEyes(image, options.layer, "a graph for two eyes such as `stereo`");
  checkEyes(reference, options.layer, "the graph `alternatives/reference_stereo`");
  const Source& where = image.file.findLayer(kCorrespondence) ? image : reference;
  const image::Layer* places = where.file.findLayer(kCorrespondence);
  if (!places)
    bad(fmt::format(
            "neither `{}` nor `{}` has the layer `{}`, which says where the right eye sees what the left "
            "one does",
            image.name, reference.name, kCorrespondence),
        "take a reference from the graph `alternatives/reference_stereo`");
  ComparedEyes eyes{prepared(image, reference, {}, options), {}, {}};
  options.layer += kRight;
  eyes.right = preparedLayer(image, reference, {}, options);
  const image::Window whole = eyes.left.display, window = common(eyes.left.window, eyes.right.window);
  if (window != whole)
    bad(fmt::format("`{}` and `{}` have only the pixels {} of a picture of {} in common", image.name,
                    reference.name, windowText(window), windowText(whole)),
        "compare eyes by whole pictures");
  if (dataOf(*places) != whole || displayOf(*places) != whole)
    bad(fmt::format("`{}` and its layer `{}` differ in size: {} and {}", where.name, kCorrespondence,
                    windowText(whole), windowText(dataOf(*places))),
        "render it again");
  eyes.correspondence = cut(where, *places, whole);
  return eyes;
}

image::EyePictures picturesOf(const Compared& eye) {
  return {&eye.image, &eye.reference, eye.halves ? &*eye.halves : nullptr};
}

}  // namespace

Compared loadCompared(const std::string& imageName, const std::string& referenceName,
                      const std::vector<std::string>& halves, const CompareOptions& options) {
  return prepared(open(imageName), open(referenceName), halves, options);
}

Compared compareRadiance(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options) {
  image.radiance = reference.radiance = true;
  return prepared({imageName, std::move(image)}, {referenceName, std::move(reference)}, {}, options);
}

void ComparedEyes::addTo(image::EyesComparison& comparison) const {
  comparison.add(picturesOf(left), picturesOf(right), correspondence, left.exposure, left.fovea);
}

ComparedEyes loadComparedEyes(const std::string& imageName, const std::string& referenceName,
                              const CompareOptions& options) {
  return preparedEyes(open(imageName), open(referenceName), options);
}

ComparedEyes compareEyes(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options) {
  image.radiance = reference.radiance = true;
  return preparedEyes({imageName, std::move(image)}, {referenceName, std::move(reference)}, options);
}

nlohmann::ordered_json describe(const Compared& c) {
  nlohmann::ordered_json json = {{"layer", c.layer},
                                 {"exposure", c.exposure},
                                 {"gaze", {c.gaze.x, c.gaze.y}},
                                 {"fovea_radius", c.radius},
                                 {"size", {c.display.width, c.display.height}}};
  if (c.window != c.display)
    json["window"] = {c.window.x - c.display.x, c.window.y - c.display.y, c.window.width, c.window.height};
  return json;
}

std::string describeInWords(const Compared& c) {
  return fmt::format("{}exposure {:.6g}, fovea of {:.4g} image widths",
                     c.layer.empty() ? "" : "layer " + c.layer + ", ", c.exposure, c.radius);
}

std::string formatMeasure(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

}  // namespace fovea::session

namespace fovea::image {

PerRegion<Measures> compare(const File& image, const File& reference, const CompareOptions& options) {
  session::CompareOptions given{options.layer, {}, options.radius, options.exposure};
  if (options.gaze) given.gaze = fmt::format("{},{}", options.gaze->x, options.gaze->y);
  const session::Compared c =
      session::prepared({"the picture", image}, {"the reference", reference}, {}, given);
  return compare(c.image, c.reference, c.halves, c.fovea, options.pixelsPerDegree);
}

}  // namespace fovea::image
