// The command `fovea compare`: how far a picture is from its reference.
#include <fmt/format.h>

#include <memory>

#include "framework/base/files.h"
#include "framework/image/error_picture.h"
#include "framework/image/flip.h"
#include "framework/session/compared.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"
#include "samples/fovea/compare_eyes.h"

namespace fovea::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  CompareOptions common;
  std::string image, reference, errorImage;
  std::vector<std::string> halves;
  double pixelsPerDegree = image::kDefaultPixelsPerDegree, errorScale = 0.1;
  bool eyes = false;
};

struct Row {
  const char* name;
  const image::Measures& measures;
  double directFloor;
};

Json toJson(const Row& row) {
  const image::Measures& m = row.measures;
  Json json = {{"pixels", m.pixels}};
  for (const auto& [name, value] : image::namedMeasures(m)) json[name] = value;
  json["direct_floor"] = row.directFloor;
  return json;
}

void print(const Options& options, const Compared& compared, const Row (&rows)[3]) {
  if (options.common.json) {
    Json json = {{"image", options.image}, {"reference", options.reference}};
    json.update(describe(compared));
    json["pixels_per_degree"] = options.pixelsPerDegree;
    for (const Row& row : rows) json[row.name] = toJson(row);
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("{} against {}: {}\n\n", options.image, options.reference, describeInWords(compared));
  constexpr const char* kLine = "{:<10} {:>9} {:>11} {:>9} {:>11} {:>9} {:>9} {:>12} {:>13}\n";
  fmt::print(kLine, "", "pixels", "MSE", "PSNR, dB", "relMSE", "FLIP", "blocks", "noise floor",
             "direct floor");
  for (const Row& row : rows) {
    const image::Measures& m = row.measures;
    fmt::print(kLine, row.name, m.pixels, formatMeasure(m.mse), formatMeasure(m.psnr),
               formatMeasure(m.relMse), formatMeasure(m.flip), formatMeasure(m.blocks),
               formatMeasure(m.noiseFloor), formatMeasure(row.directFloor));
  }
  if (!compared.halves)
    fmt::print(
        "\nNo halves of this reference (layers half_a, half_b): its noise is not known, nor subtracted.\n");
}

void writeErrors(const Options& options, const std::vector<float>& errors, const Compared& compared) {
  if (!options.errorImage.empty())
    image::write(options.errorImage, {{"", image::errorPicture(errors, compared.image.display.width,
                                                               options.errorScale, &compared.fovea)}});
}

ExitCode compareEyes(const Options& options) {
  const ComparedEyes eyes = loadComparedEyes(options.image, options.reference, options.common);
  if (!options.errorImage.empty()) checkOutputs({options.errorImage});
  image::EyesComparison comparison;
  eyes.addTo(comparison);
  writeErrors(options, comparison.pixelExcess(), eyes.left);
  Json head;
  if (options.common.json) {
    head = {{"image", options.image}, {"reference", options.reference}};
    head.update(describe(eyes.left));
  }
  printEyes(
      comparison, head,
      fmt::format("eyes of {} against {}: {}", options.image, options.reference, describeInWords(eyes.left)));
  return ExitCode::Ok;
}

ExitCode compare(const Options& options) {
  const Compared c = loadCompared(options.image, options.reference, options.halves, options.common);
  if (!options.errorImage.empty()) checkOutputs({options.errorImage});
  const auto measures = image::compare(c.image, c.reference, c.halves, c.fovea, options.pixelsPerDegree);
  image::PerRegion<double> floor{image::kUnknown, image::kUnknown, image::kUnknown};
  if (c.perfectIndirect) floor = image::meanSquaredError(*c.perfectIndirect, c.reference, c.fovea);
  if (!options.errorImage.empty()) writeErrors(options, image::pixelErrors(c.image, c.reference), c);
  print(options, c,
        {{"fovea", measures.fovea, floor.fovea},
         {"periphery", measures.periphery, floor.periphery},
         {"whole", measures.whole, floor.whole}});
  return ExitCode::Ok;
}

ExitCode run(const Options& options) {
  if (!options.errorImage.empty()) image::checkWritable(options.errorImage);
  const ExitCode code = options.eyes ? compareEyes(options) : compare(options);
  if (!options.errorImage.empty() && !options.common.json) fmt::print("wrote {}\n", options.errorImage);
  return code;
}

}  // namespace

void addCompare(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("compare", "Measure how far a picture is from its reference; needs no device");
  auto options = std::make_shared<Options>();
  command->add_option("IMAGE", options->image, "Picture: .exr or .pfm (radiance), or as displayed (.png)")
      ->required()
      ->type_name("");
  command->add_option("REFERENCE", options->reference, "What it should look like")->required()->type_name("");
  addCompareOptions(*command, options->common);
  CLI::Option* eyes = addEyesFlag(*command, options->eyes);
  command
      ->add_option(
          "--halves", options->halves,
          "Two independent halves of the reference, for its noise; default: its layers\nhalf_a and half_b")
      ->type_name("A B")
      ->expected(2)
      ->excludes(eyes);
  command
      ->add_option("--error-image", options->errorImage,
                   "Write where the errors are (root of the mean square over RGB), with the fovea")
      ->type_name("FILE");
  command
      ->add_option("--error-scale", options->errorScale,
                   "Error of that picture's lightest colour; default 0.1")
      ->type_name("X")
      ->check(numberBetween(1e-6, 1e3));
  command
      ->add_option("--ppd", options->pixelsPerDegree,
                   "Pixels per degree of visual angle, for FLIP; default 67")
      ->type_name("P")
      ->check(numberBetween(1, 1000))
      ->excludes(eyes);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace fovea::cli
