// Runs one job of a benchmark suite, from its graph to its result.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/runner/folder.h"
#include "benchmarks/runner/suite.h"
#include "framework/gpu/device.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/progress.h"
#include "framework/session/timings.h"

namespace fovea::bench {

class BenchRunner {
 public:
  BenchRunner(const BenchFolder& folder, std::shared_ptr<gpu::Device> device, session::Progress& progress);

  // What the result depends on; finds every mistake in the job's scene, graph and parameters. Throws Error(BadInput)
  // with the place in the suite. Returns nullopt if an optional scene is missing; `why` then gives the reason.
  std::optional<Fingerprint> fingerprint(const Job& job, std::string& why);
  // Throws Error(Interrupted) if Ctrl-C was pressed.
  nlohmann::ordered_json measure(const Job& job, const Fingerprint& fingerprint);

  struct Reference {
    std::string name;  // of its file, without .exr: scene, size, frame and a hash of its inputs
    uint64_t frame = 0;
  };
  // The references with which the job is compared: those of every frame, or that of the last one.
  std::vector<Reference> references(const Job& job);
  // The references made since the last call, and the seconds that each took.
  std::vector<std::pair<std::string, double>> takeMadeReferences() { return std::exchange(made_, {}); }
  // Makes the reference unless it exists; returns false if it did. Throws as measure() does.
  bool makeReference(const Job& job, const Reference& wanted);

 private:
  struct Sequence {                   // frames of one run
    std::vector<image::File> frames;  // all `frames` of the job if requested, else the last one
    nlohmann::ordered_json time;
  };
  bool useScene(const Job& job, std::string& why);
  std::unique_ptr<session::GraphRun> makeRun(const Job& job, bool pictures);
  Sequence render(const Job& job);
  image::File toFile(const session::GraphRun& run, graph::FrameResult& result, bool eyes) const;
  Reference referenceOf(const Job& job, uint64_t frame, const std::string& parts);
  image::File reference(const Job& job, uint64_t frame);
  nlohmann::ordered_json referenceParts(const Job& job);
  nlohmann::ordered_json errors(const Job& job, const image::File& last);
  nlohmann::ordered_json temporal(const Job& job, const Sequence& sequence);
  nlohmann::ordered_json eyes(const Job& job, const Sequence& sequence);
  nlohmann::ordered_json search(Job& job);
  double errorWith(const Job& job, uint32_t count);
  void writePicture(const std::string& name, const image::Image& picture) const;

  const BenchFolder& folder_;
  std::shared_ptr<gpu::Device> device_;
  session::Progress& progress_;
  std::string sceneName_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  std::vector<std::pair<std::string, double>> made_;
  std::map<std::string, std::string> missing_;  // optional scenes that are missing, and why
};

}  // namespace fovea::bench
