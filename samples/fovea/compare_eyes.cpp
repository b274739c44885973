#include "samples/fovea/compare_eyes.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/session/compared.h"

namespace fovea::cli {
namespace {

using EyeRegion = std::pair<const char*, const image::EyeMeasures&>;

void printEyesAsJson(nlohmann::ordered_json json, const EyeRegion (&regions)[3], bool sequence) {
  for (const auto& [region, measures] : regions) {
    json[region] = {{"pixels", measures.pixels}};
    for (const auto& [name, value] : namedMeasures(measures, sequence)) json[region][name] = value;
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

CLI::Option* addEyesFlag(CLI::App& command, bool& eyes) {
  return command.add_flag("--eyes", eyes,
                          "Measure by how much the eyes of stereo pictures disagree: layers radiance and\n"
                          "radiance_right of both files, and correspondence of one of them, as in\nthose of "
                          "alternatives/reference_stereo");
}

void printEyes(const image::EyesComparison& comparison, const nlohmann::ordered_json& head,
               const std::string& title) {
  const auto result = comparison.result();
  const EyeRegion regions[] = {
      {"fovea", result.fovea}, {"periphery", result.periphery}, {"whole", result.whole}};
  const bool sequence = comparison.frames() > 1;
  if (!head.is_null()) return printEyesAsJson(head, regions, sequence);
  fmt::print("{}\n\n", title);
  constexpr const char* kLine = "{:<10} {:>9} {:>7} {:>11} {:>12} {:>11} {:>12}";
  const auto line = [&](const std::string& flicker, const std::string& noise, const auto&... cells) {
    fmt::print(kLine, cells...);
    if (sequence) fmt::print(" {:>11} {:>12}", flicker, noise);
    fmt::print("\n");
  };
  line("flicker", "its noise", "", "pixels", "share", "difference", "reference's", "excess", "noise floor");
  const auto shown = [](double value) { return session::formatMeasure(value); };
  for (const auto& [name, m] : regions)
    line(shown(m.flicker), shown(m.flickerNoiseFloor), name, m.pixels, shown(m.share), shown(m.difference),
         shown(m.referenceDifference), shown(m.excess), shown(m.noiseFloor));
  if (std::isnan(result.whole.noiseFloor) && result.whole.pixels > 0)
    fmt::print(
        "\nNo halves of this reference for both eyes (layers half_a, half_b, half_a_right, half_b_right): "
        "its\n"
        "noise is not known, nor subtracted.\n");
}

}  // namespace fovea::cli
