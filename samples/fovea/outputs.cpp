#include "samples/fovea/outputs.h"
#include "framework/session/graph_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "fovea/error.h"
#include "framework/base/files.h"
#include "framework/gpu/format.h"
#include "framework/graph/compile/plan.h"
#include "samples/fovea/arguments.h"

namespace fovea::cli {
namespace {

using Type = gpu::FormatInfo::Type;

constexpr const char* kDisplay = "image";
constexpr const char* kLinear = "radiance";
constexpr uint64_t kLateFrame = 99'999'999;  // out_%d.png and out_%04d.png meet in late frames only

bool isPicture(const graph::ResourceDesc& desc) {
  return desc.kind == graph::ResourceKind::Image && !desc.volume && desc.layers == 1;
}

bool isFloat(const graph::ResourceDesc& desc) { return gpu::formatInfo(desc.format).type == Type::Float; }

// Integer formats hold numbers, not colours.
bool isColor(const graph::ResourceDesc& desc) {
  const Type type = gpu::formatInfo(desc.format).type;
  return type != Type::Uint && type != Type::Sint;
}

enum class Content { AllFloat, Display, Linear };

Content contentOf(const std::string& extension) {
  if (extension == "exr") return Content::AllFloat;
  return extension == "pfm" ? Content::Linear : Content::Display;
}

template <class Accept>
std::vector<std::string> pictureNames(const graph::BoundGraph& graph, Accept accept) {
  std::vector<std::string> names;
  for (const graph::BoundOutput& output : graph.outputs) {
    const graph::ResourceDesc& desc = graph.resources[output.resource].desc;
    if (isPicture(desc) && accept(desc)) names.push_back(output.name);
  }
  return names;
}

// The alpha of a graph's images has no meaning for a viewer of the file.
image::Image withoutAlpha(const image::Image& image) {
  if (image.channels != 4) return image;
  image::Image rgb{image.width, image.height, 3, {}};
  rgb.data.reserve(size_t(image.width) * image.height * 3);
  for (size_t i = 0; i < image.data.size(); i += 4)
    rgb.data.insert(rgb.data.end(), image.data.begin() + ptrdiff_t(i), image.data.begin() + ptrdiff_t(i + 3));
  return rgb;
}

}  // namespace

std::string OutputFiles::File::extension() const {
  std::string text = std::filesystem::path(name).extension().string();
  if (!text.empty()) text.erase(0, 1);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

std::string OutputFiles::File::shown() const {
  if (!output.empty()) return output;
  return contentOf(extension()) == Content::Linear ? kLinear : kDisplay;
}

std::string OutputFiles::File::path(uint64_t frame) const {
  return sequence ? fmt::format("{}{:0{}}{}", prefix, frame, digits, suffix) : name;
}

std::optional<uint64_t> OutputFiles::File::frameOf(const std::filesystem::path& other) const {
  const std::string text = other.filename().string();
  const std::string start = std::filesystem::path(prefix).filename().string();
  if (!sequence || !text.starts_with(start) || text.size() <= start.size()) return {};
  uint64_t frame = 0;
  const auto [end, error] = std::from_chars(text.data() + start.size(), text.data() + text.size(), frame);
  return error == std::errc() && sameFile(path(frame), other) ? std::optional(frame) : std::nullopt;
}

OutputFiles::File OutputFiles::parse(const std::string& text) {
  File file;
  std::string name = text;
  const size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && text.find('/') > equals) {
    file.output = text.substr(0, equals);
    name = text.substr(equals + 1);
  }
  file.name = name;
  const size_t percent = name.find('%');
  if (percent == std::string::npos) return file;
  size_t end = percent + 1;
  while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
  const bool good = end < name.size() && name[end] == 'd' && end - percent <= 3 &&
                    name.find('%', end) == name.npos && (end == percent + 1 || name[percent + 1] == '0');
  if (!good)
    throw Error(ExitCode::Usage, "the output name `" + name + "` has a % that is not one frame number",
                "write %d or %04d once, e.g. out_%04d.exr");
  file.sequence = true;
  file.digits = end == percent + 1 ? 1 : std::max(1, std::stoi(name.substr(percent + 1, end - percent - 1)));
  file.prefix = name.substr(0, percent);
  file.suffix = name.substr(end + 1);
  return file;
}

OutputFiles::OutputFiles(std::vector<std::string> names) {
  const std::vector<std::string> known = image::writableExtensions();
  for (const std::string& name : names) {
    File file = parse(name);
    if (std::find(known.begin(), known.end(), file.extension()) == known.end())
      throw Error(ExitCode::Usage,
                  fmt::format("cannot tell a picture format from the output name `{}`", name),
                  "this build writes " + quoteList(known));
    files_.push_back(std::move(file));
  }
}

bool OutputFiles::hasSequence() const {
  return std::any_of(files_.begin(), files_.end(), [](const File& f) { return f.sequence; });
}

void OutputFiles::checkWritable() const {
  for (const File& file : files_) image::checkWritable(file.path(0));
}

std::vector<std::filesystem::path> OutputFiles::paths(std::vector<std::filesystem::path> others) const {
  for (const File& file : files_)
    if (!file.sequence) others.emplace_back(file.name);
  std::vector<std::filesystem::path> list;
  for (const File& file : files_) {
    list.emplace_back(file.path(0));
    if (!file.sequence) continue;
    list.emplace_back(file.path(kLateFrame));
    for (const std::filesystem::path& other : others)
      if (const auto frame = file.frameOf(other); frame && *frame > 0) list.emplace_back(file.path(*frame));
  }
  return list;
}

std::vector<std::string> OutputFiles::outputsOf(const graph::BoundGraph& graph, glm::uvec2 size) {
  const std::vector<std::string> all = pictureNames(graph, isColor);
  layers_ = pictureNames(graph, [&](const graph::ResourceDesc& desc) {
    return isFloat(desc) && desc.width == size.x && desc.height == size.y;
  });
  std::set<std::string> names;
  for (const File& file : files_) {
    if (contentOf(file.extension()) == Content::AllFloat && file.output.empty()) {
      names.insert(layers_.begin(), layers_.end());
      if (!layers_.empty()) continue;
      throw Error(
          ExitCode::BadInput,
          fmt::format("graph `{}` has no floating-point output of {}x{} pixels for `{}`; its pictures are {}",
                      graph.name, size.x, size.y, file.name, quoteList(all)),
          "add one to \"outputs\" in the graph, e.g. \"radiance\": \"deferred.radiance\"");
    }
    const std::string wanted = file.shown();
    if (std::find(all.begin(), all.end(), wanted) == all.end())
      throw Error(ExitCode::BadInput,
                  fmt::format("graph `{}` has no output `{}`, which `{}` would show; its pictures are {}",
                              graph.name, wanted, file.name, quoteList(all)),
                  "name it in \"outputs\" of the graph, e.g. \"image\": \"tonemap.image\", or write .exr");
    names.insert(wanted);
    // What is no number shows as black in a display format, so that only the radiance tells.
    if (wanted == kDisplay && std::ranges::count(layers_, kLinear) > 0) names.insert(kLinear);
  }
  return {names.begin(), names.end()};
}

void OutputFiles::check(const graph::FrameResult& frame) {
  for (const auto& [name, output] : frame.outputs) {
    if (output.desc.kind != graph::ResourceKind::Image || !isFloat(output.desc)) continue;
    const image::Image picture = withoutAlpha(session::toImage(output));
    if (std::ranges::all_of(picture.data, [](float v) { return std::isnan(v); }))
      withoutNumbers_.insert(name);
  }
}

void OutputFiles::write(File& file, const graph::FrameResult& frame, image::Metadata metadata) {
  const Content content = contentOf(file.extension());
  const bool allLayers = content == Content::AllFloat && file.output.empty();
  metadata["frame"] = std::to_string(frame.frame);
  std::vector<image::Layer> layers;
  for (const auto& [name, output] : frame.outputs) {
    const bool shown =
        allLayers ? std::find(layers_.begin(), layers_.end(), name) != layers_.end() : name == file.shown();
    if (!shown) continue;
    layers.push_back({content == Content::AllFloat ? name : "", withoutAlpha(session::toImage(output))});
    if (output.beyondRange > 0) beyondRange_[name] = std::max(beyondRange_[name], output.beyondRange);
  }
  if (overlay_ && content == Content::Display && file.output.empty())
    for (image::Layer& layer : layers) overlay_(layer.image, frame.frame);
  const std::string path = file.path(frame.frame);
  image::write(path, layers, metadata);
  if (file.first.empty()) file.first = path;
  file.last = path;
}

void OutputFiles::writeFrame(const graph::FrameResult& frame, const image::Metadata& metadata) {
  check(frame);
  for (File& file : files_)
    if (file.sequence) write(file, frame, metadata);
}

void OutputFiles::writeLast(const graph::FrameResult& frame, const image::Metadata& metadata) {
  check(frame);
  for (File& file : files_)
    if (!file.sequence) write(file, frame, metadata);
}

std::vector<std::string> OutputFiles::written() const {
  std::vector<std::string> list;
  for (const File& file : files_)
    if (!file.first.empty())
      list.push_back(file.first == file.last ? file.first : file.first + " ... " + file.last);
  return list;
}

}  // namespace fovea::cli
