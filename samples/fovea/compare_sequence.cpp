// The command `fovea compare-sequence`: how steady a sequence is, and how far its changes are from those
// of its reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "framework/session/compared.h"
#include "framework/session/progress.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"
#include "samples/fovea/compare_eyes.h"

namespace fovea::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct SequenceOptions {
  CompareOptions common;
  std::string sequence, reference;
  bool eyes = false;
};

using Frames = std::map<uint64_t, std::string>;  // number in the name -> file

[[noreturn]] void bad(const std::string& message, const std::string& remedy) {
  throw Error(ExitCode::BadInput, message, remedy);
}

bool allDigits(const std::string& text) {
  return !text.empty() && text.size() < 19 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<std::string> filesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (entry->path().filename().string().front() != '.') names.push_back(entry->path().filename().string());
  if (failed) bad("cannot read the folder `" + folder.string() + "`: " + failed.message(), "check the name");
  std::sort(names.begin(), names.end());
  return names;
}

// Finds every file that matches a pattern such as "out_%04d.exr".
Frames framesOfPattern(const std::string& pattern) {
  const fs::path path(pattern);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string name = path.filename().string();
  const size_t percent = name.find('%'), end = name.find('d', percent);
  const std::string width = end == name.npos ? "x" : name.substr(percent + 1, end - percent - 1);
  if (!(width.empty() || allDigits(width)) || name.find('%', percent + 1) != name.npos)
    bad("`" + pattern + "` has a % that is not one frame number", "write %d or %04d once, e.g. out_%04d.exr");
  const std::string prefix = name.substr(0, percent), suffix = name.substr(end + 1);
  Frames frames;
  for (const std::string& file : filesIn(folder)) {
    if (file.size() <= prefix.size() + suffix.size() || !file.starts_with(prefix) || !file.ends_with(suffix))
      continue;
    const std::string number = file.substr(prefix.size(), file.size() - prefix.size() - suffix.size());
    if (allDigits(number)) frames[std::stoull(number)] = (folder / file).string();
  }
  return frames;
}

// The only numbered sequence in a folder: of .exr files if there are any, else of .pfm, else of .png.
Frames framesInFolder(const std::string& folder) {
  for (const char* extension : {".exr", ".pfm", ".png"}) {
    Frames frames;
    std::string common;
    for (const std::string& file : filesIn(folder)) {
      if (fs::path(file).extension() != extension) continue;
      const size_t last = file.find_last_of("0123456789");
      if (last == file.npos) continue;
      const size_t before = file.find_last_not_of("0123456789", last);
      const size_t first = before == file.npos ? 0 : before + 1;
      const std::string number = file.substr(first, last + 1 - first);
      if (!allDigits(number)) continue;
      const std::string name = file.substr(0, first) + "%d" + file.substr(last + 1);
      if (!frames.empty() && name != common)
        bad(fmt::format("the folder `{}` has more than one sequence: {} and {}", folder, common, name),
            "name one, e.g. " + (fs::path(folder) / name).string());
      common = name;
      frames[std::stoull(number)] = (fs::path(folder) / file).string();
    }
    if (!frames.empty()) return frames;
  }
  return {};
}

Frames findFrames(const std::string& name) {
  std::error_code ignored;
  Frames frames;
  if (fs::is_directory(name, ignored)) {
    frames = framesInFolder(name);
  } else if (fs::path(name).filename().string().find('%') != std::string::npos) {
    frames = framesOfPattern(name);
  } else {
    bad("`" + name + "` is neither a folder nor a name with a frame number", "e.g. out_%04d.exr");
  }
  if (frames.empty()) bad("`" + name + "` has no frames", "render them with -o out_%04d.exr");
  for (auto frame = frames.begin(), next = std::next(frame); next != frames.end(); frame = next++)
    if (next->first != frame->first + 1)
      bad(fmt::format("`{}` lacks frame {}: after `{}` comes `{}`", name, frame->first + 1, frame->second,
                      next->second),
          "MSE' is between consecutive frames: render them all");
  return frames;
}

void checkSameFrames(const SequenceOptions& options, const Frames& a, const Frames& b) {
  if (a.begin()->first == b.begin()->first && a.size() == b.size()) return;
  bad(fmt::format("`{}` has frames {} to {} and `{}` has {} to {}", options.sequence, a.begin()->first,
                  a.rbegin()->first, options.reference, b.begin()->first, b.rbegin()->first),
      "render the same frames of both: --warmup and --frames");
}

Json toJson(const image::SequenceMeasures& m) {
  return {{"pairs", m.pairs},
          {"mse", m.mse},
          {"noise_floor", m.noiseFloor},
          {"mse_prime", m.change},
          {"reference_mse_prime", m.referenceChange},
          {"excess", m.excess},
          {"excess_noise_floor", m.excessNoiseFloor}};
}

Json headOf(const SequenceOptions& options, const Frames& frames, const Compared& last) {
  Json json = {{"sequence", options.sequence}, {"reference", options.reference}};
  json.update(describe(last));
  json.erase("gaze");  // the gaze moves
  json["frames"] = frames.size();
  json["first_frame"] = frames.begin()->first;
  return json;
}

std::string titleOf(const SequenceOptions& options, const Frames& frames, const Compared& last) {
  return fmt::format("{} against {}: frames {} to {}, {}", options.sequence, options.reference,
                     frames.begin()->first, frames.rbegin()->first, describeInWords(last));
}

void print(const SequenceOptions& options, const Frames& frames, const Compared& last,
           const image::PerRegion<image::SequenceMeasures>& result) {
  const std::pair<const char*, const image::SequenceMeasures&> rows[] = {
      {"fovea", result.fovea}, {"periphery", result.periphery}, {"whole", result.whole}};
  if (options.common.json) {
    Json json = headOf(options, frames, last);
    for (const auto& [name, measures] : rows) json[name] = toJson(measures);
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("{}\n\n", titleOf(options, frames, last));
  constexpr const char* kLine = "{:<10} {:>6} {:>11} {:>11} {:>16} {:>11} {:>14}\n";
  fmt::print(kLine, "", "pairs", "MSE", "MSE'", "reference's MSE'", "excess", "its noise");
  for (const auto& [name, m] : rows)
    fmt::print(kLine, name, m.pairs, formatMeasure(m.mse), formatMeasure(m.change),
               formatMeasure(m.referenceChange), formatMeasure(m.excess), formatMeasure(m.excessNoiseFloor));
  if (std::isnan(result.whole.noiseFloor))
    fmt::print(
        "\nNo halves of this reference (layers half_a, half_b): its noise is not known, nor subtracted.\n");
}

// Loads the frames one by one, and hands each to `add` after it was found to be like the one before. load(file, its
// reference): a frame; readingOf(frame): how its files were read. Returns the last frame.
template <class Load, class ReadingOf, class Add>
auto eachFrame(const SequenceOptions& options, const Frames& frames, const Frames& references, Load load,
               ReadingOf readingOf, Add add) {
  Progress progress(options.common.json, 0);
  decltype(load(std::string(), std::string())) last;
  uint64_t count = 0;
  for (const auto& [number, file] : frames) {
    progress.frames(count, frames.size());
    auto frame = load(file, references.at(number));
    const Compared &now = readingOf(frame), &before = readingOf(last);
    if (count > 0 && now.exposure != before.exposure)
      bad(fmt::format("the exposure changes from {} to {} at `{}`", before.exposure, now.exposure, file),
          "changes compare only at one exposure: give --exposure");
    if (count > 0 && (now.window != before.window || now.layer != before.layer))
      bad(fmt::format("from `{}` on, the frames show another layer or other pixels", file),
          "render all of them alike");
    add(frame);
    last = std::move(frame);
    ++count;
  }
  progress.clear();
  return last;
}

void compareEyes(const SequenceOptions& options, const Frames& frames, const Frames& references) {
  image::EyesComparison comparison;
  const ComparedEyes last = eachFrame(
      options, frames, references,
      [&](const std::string& image, const std::string& reference) {
        return loadComparedEyes(image, reference, options.common);
      },
      [](const ComparedEyes& eyes) -> const Compared& { return eyes.left; },
      [&](const ComparedEyes& eyes) { eyes.addTo(comparison); });
  printEyes(comparison, options.common.json ? headOf(options, frames, last.left) : Json(),
            "eyes of " + titleOf(options, frames, last.left));
}

void comparePictures(const SequenceOptions& options, const Frames& frames, const Frames& references) {
  image::SequenceComparison comparison;
  const Compared last = eachFrame(
      options, frames, references,
      [&](const std::string& image, const std::string& reference) {
        return loadCompared(image, reference, {}, options.common);
      },
      [](const Compared& compared) -> const Compared& { return compared; },
      [&](Compared& now) {
        comparison.add(std::move(now.image), std::move(now.reference), std::move(now.halves), now.fovea);
      });
  print(options, frames, last, comparison.result());
}

ExitCode compareSequence(const SequenceOptions& options) {
  const Frames frames = findFrames(options.sequence), references = findFrames(options.reference);
  checkSameFrames(options, frames, references);
  options.eyes ? compareEyes(options, frames, references) : comparePictures(options, frames, references);
  return ExitCode::Ok;
}

}  // namespace

void addCompareSequence(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "compare-sequence",
      "Measure how the changes of a sequence differ from its reference's; needs no device");
  auto options = std::make_shared<SequenceOptions>();
  command
      ->add_option("SEQUENCE", options->sequence,
                   "A folder of numbered pictures, or a name like out_%04d.exr")
      ->required()
      ->type_name("");
  command->add_option("REFERENCE", options->reference, "The same frames as they should look")
      ->required()
      ->type_name("");
  addCompareOptions(*command, options->common);
  addEyesFlag(*command, options->eyes);
  command->callback([options, &action] { action = [options] { return compareSequence(*options); }; });
}

}  // namespace fovea::cli
