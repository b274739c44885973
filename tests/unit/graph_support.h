// Shared by the tests of the graph compiler: small pass types, graphs from text, and plans as readable lines.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/base/random.h"
#include "framework/graph/compile/compile.h"

namespace fovea::graph::test {

inline constexpr VkFormat kColor = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT;

// Pass types with one obvious port each: source, filter, blend (two inputs), sink, draw (bundle), shade,
// update (in-out), ...
inline void addBasicTypes(Registry& registry) {
  PassDeclaration source("source", "Makes an image");
  source.output("image", image2D(kColor), Usage::StorageWrite, "made");
  source.parameter("count", integer(3, 1, 10), "a number")
      .parameter("radius", real(0.5, 0, 1, "m"), "a length");
  source.parameter("kernel", choice("disc", {"disc", "clamp"}), "a choice")
      .parameter("fast", flag(false), "a flag");
  source.parameter("label", text("none"), "a text");
  registry.add(source, nullptr);

  PassDeclaration filter("filter", "Reads one image, writes another");
  filter.input("image", image2D(kColor), Usage::Sampled, "read");
  filter.output("image_out", image2D(kColor), Usage::StorageWrite, "written");
  registry.add(filter, nullptr);

  PassDeclaration blend("blend", "Reads two images");
  blend.input("a", image2D(kColor), Usage::Sampled, "first");
  blend.input("b", image2D(kColor), Usage::Sampled, "second").makeOptional();
  blend.output("image", image2D(kColor), Usage::StorageWrite, "written");
  registry.add(blend, nullptr);

  PassDeclaration storageFilter("storage-filter", "Reads one image as a storage image");
  storageFilter.input("image", image2D(kColor), Usage::StorageRead, "read");
  storageFilter.output("image_out", image2D(kColor), Usage::StorageWrite, "written");
  registry.add(storageFilter, nullptr);

  PassDeclaration update("update", "Changes an image in place");
  update.inout("image", image2D(kColor), Usage::StorageRead | Usage::StorageWrite, "changed");
  registry.add(update, nullptr);

  PassDeclaration bend("bend", "Changes the normals of a G-buffer in place");
  bend.inout("gbuffer", "gbuffer",
             {member("normal", image2D(kColor), Usage::StorageRead | Usage::StorageWrite)}, "surfaces");
  registry.add(bend, nullptr);

  PassDeclaration keep("keep", "Keeps an image from frame to frame");
  keep.input("image", image2D(kColor), Usage::Sampled, "read");
  keep.output("sum", image2D(kColor), Usage::StorageRead | Usage::StorageWrite, "kept").keep(Lifetime::View);
  registry.add(keep, nullptr);

  PassDeclaration draw("draw", "Draws a G-buffer", PassKind::Graphics);
  draw.view();
  draw.output("gbuffer", "gbuffer",
              {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::ColorAttachment, "where"),
               member("normal", image2D(kColor), Usage::ColorAttachment, "which way"),
               member("depth", image2D(kDepth), Usage::DepthAttachment, "how far")},
              "surfaces");
  registry.add(draw, nullptr);

  PassDeclaration shade("shade", "Shades a G-buffer");
  shade.input("gbuffer", "gbuffer",
              {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::Sampled),
               member("depth", image2D(kDepth), Usage::Sampled)},
              "surfaces");
  shade.input("vpls", buffer("Vpl", 64), Usage::Uniform, "lights").makeOptional();
  shade.output("image", image2D(kColor), Usage::StorageWrite, "lit");
  registry.add(shade, nullptr);

  PassDeclaration emit("emit", "Makes lights");
  emit.parameter("vpl_count", integer(100, 1, 100000), "how many");
  emit.output("vpls", buffer("Vpl", 64, parameter("vpl_count")), Usage::StorageWrite, "lights");
  emit.scratch("paths", buffer("Path", 32, parameter("vpl_count") * SizeExpr(2)), Usage::StorageWrite,
               "paths");
  registry.add(emit, nullptr);

  PassDeclaration host("host", "Works on the CPU", PassKind::Host);
  host.input("image", image2D(kColor), Usage::HostRead, "read");
  host.output("image_out", image2D(kColor), Usage::HostWrite, "written");
  registry.add(host, nullptr);

  PassDeclaration log("log", "Has side effects");
  log.sideEffects = true;
  log.input("image", image2D(kColor), Usage::Sampled, "read");
  registry.add(log, nullptr);

  PassDeclaration atlas("atlas", "Many layers");
  atlas.input("vpls", buffer("Vpl", 64), Usage::StorageRead, "lights");
  atlas.parameter("map_size", integer(128, 1, 4096), "texels a side");
  atlas.output("maps", image2DArray(kDepth, parameter("map_size"), parameter("map_size"), countOf("vpls")),
               Usage::TransferWrite, "one a light");
  registry.add(atlas, nullptr);

  PassDeclaration half("half", "Half the size of its input");
  half.input("image", image2D(kColor), Usage::Sampled, "read");
  half.output("small", image2D(kColor, ceilDiv(widthOf("image"), 2), ceilDiv(heightOf("image"), 2)),
              Usage::StorageWrite, "half");
  registry.add(half, nullptr);
}

struct Compiled {
  std::shared_ptr<Registry> registry;
  std::shared_ptr<const BoundGraph> graph;
  Plan plan;
  Diagnostics messages;

  uint32_t pass(const std::string& name) const {
    for (uint32_t p = 0; p < graph->passes.size(); ++p)
      if (graph->passes[p].name == name) return p;
    return kNone;
  }
  uint32_t resource(const std::string& name) const {
    for (uint32_t r = 0; r < graph->resources.size(); ++r)
      if (graph->resources[r].name == name) return r;
    return kNone;
  }
  const Placement& placement(const std::string& name) const {
    for (const Placement& p : plan.placements)
      if (graph->resources[p.resource].name == name) return p;
    throw std::runtime_error("no placement of " + name);
  }
  // "a b | c | d": levels from left to right.
  std::string order() const {
    std::string text;
    for (const Level& level : plan.levels) {
      if (!text.empty()) text += " | ";
      for (size_t i = 0; i < level.passes.size(); ++i)
        text += (i ? " " : "") + graph->passes[level.passes[i]].name;
    }
    return text;
  }
};

inline std::shared_ptr<Registry> basicRegistry() {
  auto registry = std::make_shared<Registry>();
  addBasicTypes(*registry);
  return registry;
}

inline Environment basicEnvironment(const Registry& registry) {
  Environment environment;
  environment.registry = &registry;
  environment.views = {{"main", {64, 32}}, {"left", {16, 16}}, {"right", {16, 16}}};
  return environment;
}

inline std::shared_ptr<const BoundGraph> bindText(const std::string& text, const Registry& registry,
                                                  Diagnostics& messages, const LoadOptions& options = {}) {
  const Description description = loadText(text, "graph.json", options, messages);
  return std::make_shared<const BoundGraph>(bind(description, basicEnvironment(registry), messages));
}

inline Compiled compileText(const std::string& text, const CompileOptions& compileOptions = {},
                            const LoadOptions& options = {}) {
  Compiled result;
  result.registry = basicRegistry();
  result.graph = bindText(text, *result.registry, result.messages, options);
  result.plan = compile(result.graph, compileOptions);
  return result;
}

// A temporary folder of files for one test.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fovea-graphs-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  TempFolder(const TempFolder&) = delete;
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// ---- Barriers in words ------------------------------------------------------------------------------------

inline std::string stageText(VkPipelineStageFlags2 stages) {
  std::string text;
  auto add = [&](VkPipelineStageFlags2 bit, const char* name) {
    if ((stages & bit) != bit) return;
    text += (text.empty() ? "" : "+") + std::string(name);
    stages &= ~bit;
  };
  add(VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect");
  add(VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex");
  add(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment");
  add(VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "depth");
  add(VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color");
  add(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute");
  add(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer");
  if (stages) text += fmt::format("+{:x}", stages);
  return text.empty() ? "none" : text;
}

inline std::string accessText(VkAccessFlags2 access) {
  std::string text;
  auto add = [&](VkAccessFlags2 bit, const char* name) {
    if (!(access & bit)) return;
    text += (text.empty() ? "" : "+") + std::string(name);
    access &= ~bit;
  };
  add(VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, "indirect");
  add(VK_ACCESS_2_UNIFORM_READ_BIT, "uniform");
  add(VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled");
  add(VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "read");
  add(VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "write");
  add(VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color-read");
  add(VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color-write");
  add(VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth-read");
  add(VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth-write");
  add(VK_ACCESS_2_TRANSFER_READ_BIT, "transfer-read");
  add(VK_ACCESS_2_TRANSFER_WRITE_BIT, "transfer-write");
  if (access) text += fmt::format("+{:x}", access);
  return text.empty() ? "none" : text;
}

inline std::string layoutText(VkImageLayout layout) {
  switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
      return "undefined";
    case VK_IMAGE_LAYOUT_GENERAL:
      return "general";
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
      return "color";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
      return "depth";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
      return "depth-read";
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
      return "sampled";
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
      return "source";
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
      return "target";
    default:
      return std::to_string(layout);
  }
}

// "memory compute:write > compute:sampled; a.image undefined > general compute:none > compute:write"
inline std::string barrierText(const BarrierBatch& batch, const BoundGraph& graph) {
  std::string text;
  if (batch.srcStage || batch.dstStage)
    text = fmt::format("memory {}:{} > {}:{}", stageText(batch.srcStage), accessText(batch.srcAccess),
                       stageText(batch.dstStage), accessText(batch.dstAccess));
  for (const ImageBarrier& b : batch.images)
    text += fmt::format("{}{}{} {} > {} {}:{} > {}:{}", text.empty() ? "" : "; ",
                        graph.resources[b.resource].name, b.previous ? "@previous" : "",
                        layoutText(b.oldLayout), layoutText(b.newLayout), stageText(b.srcStage),
                        accessText(b.srcAccess), stageText(b.dstStage), accessText(b.dstAccess));
  return text;
}

}  // namespace fovea::graph::test
