#include "samples/fovea/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/base/number.h"
#include "framework/gpu/device.h"

namespace fovea::cli {

CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                     const std::string& doc) {
  return command.add_option(name, values, doc)->allow_extra_args(false);
}

void addPluginOption(CLI::App& command, std::vector<std::string>& plugins) {
  addList(command, "--plugin", plugins, "Shared library with more passes; may be repeated")
      ->type_name("FILE.so");
}

void addPassesOption(CLI::App& command, std::vector<std::string>& folders) {
  addList(command, "--passes", folders, "Folder with passes in files (NAME.pass.json); may be repeated")
      ->type_name("DIR");
}

namespace {

void addRaysOption(CLI::App& command, session::RaysOn& rays) {
  using session::RaysOn;
  static const std::map<std::string, RaysOn> kPlaces = {
      {"auto", RaysOn::Auto}, {"host", RaysOn::Host}, {"device", RaysOn::Device}};
  command
      .add_option_function<std::string>(
          "--rays", [&rays](const std::string& place) { rays = kPlaces.at(place); },
          "Where passes trace rays: on the `host` with Embree, on the `device` in compute shaders, or\n"
          "`auto`, which is the host if the device is a CPU; the results agree but for rounding")
      ->type_name("PLACE")
      ->check(CLI::IsMember({"auto", "host", "device"}));
}

using ValueType = graph::ParameterSpec::Type;

CLI::Validator valuesOf(const graph::ParameterSpec& spec) {
  if (spec.type == ValueType::Choice) return CLI::IsMember(spec.choices).description("");
  if (spec.type == ValueType::Int) return wholeNumberBetween(int64_t(spec.min), int64_t(spec.max));
  return numberBetween(spec.min, spec.max);
}

std::string valueName(const graph::ParameterSpec& spec) {
  if (spec.type == ValueType::Choice) return fmt::format("{}", fmt::join(spec.choices, "|"));
  return spec.type == ValueType::Int ? "N" : "X";
}

// Breaks a text into lines as long as those of the other options' help.
std::string wrapped(std::string text) {
  constexpr size_t kWidth = 80;
  for (size_t begin = 0; text.size() - begin > kWidth;) {
    const size_t space = text.rfind(' ', begin + kWidth);
    if (space == std::string::npos || space <= begin) break;
    text[space] = '\n';
    begin = space + 1;
  }
  return text;
}

// What belongs to the frame: --fovea-radius 0.2 stands for --set view.fovea_radius=0.2.
void addViewOptions(CLI::App& command, std::vector<std::string>& set) {
  for (const graph::ParameterSpec& spec : graph::viewParameters()) {
    std::string option = "--" + spec.name;
    std::ranges::replace(option, '_', '-');
    const std::string doc = spec.unit.empty() ? spec.doc : fmt::format("{} [{}]", spec.doc, spec.unit);
    command
        .add_option_function<std::string>(
            option,
            [&set, name = spec.name](const std::string& value) {
              set.push_back(fmt::format("view.{}={}", name, value));
            },
            wrapped(doc))
        ->type_name(valueName(spec))
        ->transform(valuesOf(spec));
  }
}

}  // namespace

void addGraphOptions(CLI::App& command, GraphOptions& options) {
  command.add_option("GRAPH", options.graph, "Graph: a file, or the bare name of a stock graph (ir_1000)")
      ->required()
      ->type_name("");
  addList(command, "--set", options.set,
          "Override a graph parameter (vpl_count=500) or a pass's (deferred.kernel=disc)")
      ->type_name("NAME=VALUE");
  addViewOptions(command, options.set);
  addPluginOption(command, options.plugins);
  addPassesOption(command, options.passes);
  addRaysOption(command, options.rays);
}

void addDeviceOptions(CLI::App& command, std::string& device, std::vector<std::string>& without) {
  command.add_option("--device", device, "Vulkan device by number or part of its name; see `fovea devices`")
      ->type_name("D");
  addWithoutOption(command, without);
}

void addWithoutOption(CLI::App& command, std::vector<std::string>& without) {
  std::string names;
  for (const std::string& name : gpu::dispensableFeatures()) names += (names.empty() ? "" : ", ") + name;
  addList(command, "--without", without,
          "Work as on a device without this feature; may be repeated:\n" + names)
      ->type_name("FEATURE");
}

void addFrameLimitOption(CLI::App& command, double& seconds) {
  command
      .add_option(
          "--frame-limit", seconds,
          "End with exit code 6 if a frame takes longer and its passes report no progress,\nas with a shader "
          "that never ends; 0: never; default 3600")
      ->type_name("S")
      ->check(numberBetween(0, 1e9));
}

void addFollowLinksOption(CLI::App& command) {
  command.add_flag_callback(
      "--follow-links", [] { setenv("FOVEA_FOLLOW_LINKS", "1", 1); },
      "Read parts of models also through links that lead out of the model's folder, as\n"
      "those of git-annex, DVC and Nix do; the same as FOVEA_FOLLOW_LINKS=1");
}

void addJsonFlag(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "Print JSON, for programs");
}

void addEnvironmentOption(CLI::App& command, std::string& file) {
  command
      .add_option("--environment", file,
                  "Light from all around instead of the scene's environment: an equirectangular\n"
                  "image in linear radiance (.exr, .hdr, .pfm)")
      ->type_name("FILE");
}

CLI::Validator numberBetween(double low, double high) {
  return CLI::Validator(
      [=](const std::string& text) {
        const std::optional<double> value = parseDecimal(text);
        return value && *value >= low && *value <= high
                   ? std::string()
                   : fmt::format("`{}` is not a number from {} to {}", text, low, high);
      },
      "");
}

CLI::Validator wholeNumberBetween(int64_t low, int64_t high) {
  return CLI::Validator(
      [=](std::string& text) {
        const std::optional<double> value = parseDecimal(text);
        if (!value || std::trunc(*value) != *value || *value < double(low) || *value > double(high))
          return fmt::format("`{}` is not a whole number from {} to {}", text, low, high);
        text = std::to_string(int64_t(*value));
        return std::string();
      },
      "");
}

void addCompareOptions(CLI::App& command, CompareOptions& options) {
  command
      .add_option(
          "--gaze", options.gaze,
          "Centre of the fovea, 0,0 (top left) to 1,1; default: as in the files' metadata,\nelse the middle")
      ->type_name("X,Y");
  command
      .add_option("--radius", options.radius,
                  "Radius of the fovea in image widths, up to 4; default: as in the metadata,\nelse 0.25")
      ->type_name("R")
      ->check(numberBetween(0, kMaxRadius));
  command
      .add_option("--layer", options.layer,
                  "Layer of both files to compare; default: radiance, or the only one")
      ->type_name("L");
  command
      .add_option("--exposure", options.exposure,
                  "Radiance is shown as sRGB(clamp(E x radiance)); default: as in the metadata, else 1")
      ->type_name("E")
      ->check(numberBetween(1e-9, 1e9));
  command.add_flag("--json", options.json, "Print JSON, null where a number is not known");
}

}  // namespace fovea::cli
