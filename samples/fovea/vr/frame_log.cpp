#include "samples/fovea/vr/frame_log.h"

#include <fmt/format.h>

#include "framework/base/text_file.h"
#include "framework/session/timings.h"

namespace fovea::vr {
namespace {

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.4f}", *value) : ""; }

std::string row(const char* name, const std::vector<double>& values) {
  if (values.empty()) return {};
  const session::Spread spread = session::spreadOf(values);
  return fmt::format("  {:<22} {:>9.2f} {:>9.2f} {:>9.2f}\n", name, spread.median, spread.min, spread.p95);
}

}  // namespace

std::string FrameLog::table() const {
  uint64_t missed = 0, blind = 0;
  std::vector<double> display, submit, recording;
  for (const LoggedFrame& frame : frames_) {
    missed += frame.missed;
    blind += !frame.gaze;
    if (frame.gazeToDisplay) display.push_back(*frame.gazeToDisplay);
    if (frame.gazeToSubmit) submit.push_back(*frame.gazeToSubmit);
    recording.push_back(frame.submitted);
  }
  std::string text =
      fmt::format("{} frames shown, {} of the display's missed, {} without gaze, {} not rendered\n",
                  frames_.size(), missed, blind, skipped_);
  if (!frames_.empty()) text += "  ms                        median       min       p95\n";
  return text + row("gaze to display", display) + row("gaze to submission", submit) +
         row("recording", recording);
}

std::string FrameLog::csv() const {
  std::string text = "frame,time_s,missed,gaze,gaze_to_display_ms,gaze_to_submit_ms,recording_ms\n";
  for (const LoggedFrame& f : frames_)
    text += fmt::format("{},{},{},{},{},{},{:.4f}\n", f.frame, f.time, f.missed, int(f.gaze),
                        cell(f.gazeToDisplay), cell(f.gazeToSubmit), f.submitted);
  return text;
}

void FrameLog::write(const std::filesystem::path& file) const { writeText(file, csv()); }

}  // namespace fovea::vr
