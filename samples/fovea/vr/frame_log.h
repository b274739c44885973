// What is counted of each frame that a headset shows: whether it came in time, and how old the gaze was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fovea::vr {

struct LoggedFrame {
  uint64_t frame = 0;
  double time = 0;      // of the scene, seconds
  uint32_t missed = 0;  // periods of the display without a new picture before this one
  bool gaze = false;    // whether the eyes were tracked
  // From the eye tracker's sample to the middle of the frame as the display shows it, and to where the frame was
  // submitted; milliseconds.
  std::optional<double> gazeToDisplay, gazeToSubmit;
  double submitted = 0;  // milliseconds that recording and submitting took on the host
};

class FrameLog {
 public:
  void add(const LoggedFrame& frame) { frames_.push_back(frame); }
  // A picture that was due while nobody could see it, or while the head was not tracked.
  void skip() { ++skipped_; }
  std::string table() const;  // for people
  std::string csv() const;    // a row a frame
  // Throws Error(CannotWrite).
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<LoggedFrame> frames_;
  uint64_t skipped_ = 0;
};

}  // namespace fovea::vr
