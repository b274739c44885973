// The pictures that a run writes: which graph outputs they need, and how frames become files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fovea/image.h"
#include "framework/graph/run/execute.h"

namespace fovea::cli {

// In an EXR file, every floating-point output of the graph that has the view's size is a layer of its name. Other
// formats show the output `image`, except for PFM (floating-point, one layer), which shows the output `radiance`.
// "OUTPUT=FILE" shows that output alone, whatever its size: "image_right=right.png".
class OutputFiles {
 public:
  // Takes names as on the command line; "out_%04d.exr" is a sequence with one file per frame. Throws Error(Usage) on
  // an invalid pattern or an unknown extension.
  explicit OutputFiles(std::vector<std::string> names);

  bool empty() const { return files_.empty(); }
  bool hasSequence() const;
  // Throws Error(CannotWrite) if a file could not be written. Call it before anything is rendered.
  void checkWritable() const;
  // The files that it may write: of a sequence the first, a late one, and each that is among `others`.
  std::vector<std::filesystem::path> paths(std::vector<std::filesystem::path> others) const;
  // Names of the graph outputs to read back. Throws Error(BadInput) if the graph lacks an output that a file shows.
  std::vector<std::string> outputsOf(const graph::BoundGraph& graph, glm::uvec2 size);

  // Draws onto every picture of the output `image` before it is written.
  using Overlay = std::function<void(image::Image& picture, uint64_t frame)>;
  void setOverlay(Overlay overlay) { overlay_ = std::move(overlay); }

  // Writes the files of the sequences.
  void writeFrame(const graph::FrameResult& frame, const image::Metadata& metadata);
  // Writes all other files, which show the last frame.
  void writeLast(const graph::FrameResult& frame, const image::Metadata& metadata);
  // The most pixels of a frame whose light passes could not store, by the output that shows them.
  const std::map<std::string, uint64_t>& beyondRange() const { return beyondRange_; }
  // Outputs of which no pixel of a frame was a number.
  const std::set<std::string>& withoutNumbers() const { return withoutNumbers_; }
  // Names of the files written, for the report: "ir.png", "out_0000.exr ... out_0041.exr".
  std::vector<std::string> written() const;

 private:
  struct File {
    std::string name;
    std::string output;  // of the graph; if empty, the default of the format
    bool sequence = false;
    std::string prefix, suffix;  // of a sequence, before and after the number
    int digits = 0;
    std::string first, last;  // first and last file written so far
    std::string path(uint64_t frame) const;
    // The frame of a sequence that this file would be.
    std::optional<uint64_t> frameOf(const std::filesystem::path& other) const;
    std::string shown() const;      // the output that it shows, if it is a single one
    std::string extension() const;  // lower case, without the dot
  };
  void check(const graph::FrameResult& frame);
  void write(File& file, const graph::FrameResult& frame, image::Metadata metadata);
  static File parse(const std::string& name);
  std::vector<File> files_;
  std::vector<std::string> layers_;  // layers of an EXR file that shows every output
  Overlay overlay_;
  std::map<std::string, uint64_t> beyondRange_;
  std::set<std::string> withoutNumbers_;
};

}  // namespace fovea::cli
