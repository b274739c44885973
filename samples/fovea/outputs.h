// The pictures a run writes: which graph outputs they need, and how frames become files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <set>
#include <string>
#include <vector>

#include "fovea/image.h"
#include "framework/graph/run/execute.h"

namespace fovea::cli {

// EXR: every floating-point output of the graph that has the view's size is a layer of its name. Other
// formats show the output `image`, or, for PFM (floating-point, one layer), the output `radiance`.
// "OUTPUT=FILE" shows that output alone, whatever its size: "image_right=right.png".
class OutputFiles {
 public:
  // Names as on the command line; "out_%04d.exr" is a sequence with a file per frame. Throws Error(Usage) on
  // a bad pattern, an unknown extension or a file named twice.
  explicit OutputFiles(std::vector<std::string> names);

  bool empty() const { return files_.empty(); }
  bool hasSequence() const;
  // Throws Error(CannotWrite) when one could not be written, before anything is rendered.
  void checkWritable() const;
  // Names of the graph outputs to read back. Throws Error(BadInput) when the graph lacks what a file shows.
  std::vector<std::string> outputsOf(const graph::BoundGraph& graph, glm::uvec2 size);

  // Draws onto every picture that shows the output `image` before it is written.
  using Overlay = std::function<void(image::Image& picture, uint64_t frame)>;
  void setOverlay(Overlay overlay) { overlay_ = std::move(overlay); }

  // Files of the sequences.
  void writeFrame(const graph::FrameResult& frame, const image::Metadata& metadata);
  // All others: the last frame.
  void writeLast(const graph::FrameResult& frame, const image::Metadata& metadata);
  // What was written, for the report: "ir.png", "out_0000.exr ... out_0041.exr".
  std::vector<std::string> written() const;

 private:
  struct File {
    std::string name;
    std::string output;  // of the graph; empty: what the format shows
    bool sequence = false;
    std::string prefix, suffix;  // of a sequence, around the number
    int digits = 0;
    std::string first, last;  // written so far
    std::string path(uint64_t frame) const;
    std::string shown() const;      // the output it shows, where that is one
    std::string extension() const;  // lower case, without the dot
  };
  void write(File& file, const graph::FrameResult& frame, image::Metadata metadata);
  static File parse(const std::string& name);
  std::vector<File> files_;
  std::vector<std::string> layers_;  // of an EXR that shows everything
  Overlay overlay_;
};

}  // namespace fovea::cli
