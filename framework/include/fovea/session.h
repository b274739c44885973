// Runs a graph file over a scene on a device, frame after frame.
//
//   fovea::passes::registerAll();
//   scene::Scene scene = scene::load("my_scene.json", messages);
//   graph::Session session("my_graph.json", scene, {.size = {512, 512}, .set = {"bounces=3"}});
//   graph::FrameResult frame = session.render(0);
//   image::Image picture = session.picture(frame, "radiance");
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/device.h"
#include "fovea/document.h"
#include "fovea/error.h"
#include "fovea/graph.h"
#include "fovea/image.h"
#include "fovea/scene.h"

namespace fovea::graph {

struct SessionOptions {
  std::shared_ptr<gpu::Device> device;  // may be that of other sessions; nullptr opens the best one
  glm::uvec2 size{512, 512};            // pixels
  uint32_t seed = 1;
  double frameRate = 42;          // frames per second of scene time
  std::vector<std::string> set;   // parameter values: "bounces=3", "blur.radius=3"
  std::vector<std::string> read;  // what render() reads back, see Session::read(); empty for all outputs
  // Called inside render() by passes that run long on the CPU, with the name of the pass and the share of its work that
  // is done, 0 to 1. Returning false asks it to finish soon with what it has.
  std::function<bool(const std::string& pass, double share)> progress{};
};

// What a frame shows. Members that are not set follow from the scene.
struct FrameOptions {
  uint64_t index = 0;                   // FrameResult::frame; random numbers and jitter follow from it
  std::optional<double> time;           // of the scene, in seconds, at least 0; not set: index / frameRate
  std::optional<scene::Camera> camera;  // world space, relative to Scene::origin; metres and radians
  std::optional<glm::vec2> gaze;        // of all views; normalised image coordinates, origin top-left
  bool cut = false;                     // shows something unrelated to the last frame: history begins anew
  bool read = true;                     // whether what Session::read() chooses is read back, which takes time
};

class Session {
 public:
  // `graph` is a file or a bare name. Passes in files are found as by the program, in the folders that FOVEA_PASSES
  // names and in a folder `passes` beside the graph; passes in C++ are those that were registered before. The scene must
  // outlive the session. Throws Error(BadInput) with every mistake of the graph, Error(Usage) for an impossible size or
  // parameter, and as gpu::openDevice() does.
  Session(const std::string& graph, const scene::Scene& scene, const SessionOptions& options = {})
      : Session(Document::load(graph), scene, options) {}
  Session(const Document& graph, const scene::Scene& scene, const SessionOptions& options = {});
  ~Session();

  // Renders a frame and waits until it is finished. Motion is relative to the frame that was rendered last, whatever
  // their numbers; before the first one, the scene is taken to have moved as it does by itself. Frames 0, 1, 2.. are
  // those of `fovea render`. Throws Error(Usage) if an input of the graph was never set or a time is impossible, and
  // otherwise what the passes throw.
  FrameResult render(uint64_t index) { return render(FrameOptions{.index = index}); }
  FrameResult render(const FrameOptions& frame);

  // Changes parameters from the next frame on: "bounces=3", "blur.radius=3". Others keep their values. What passes
  // keep and the history of the views go on wherever neither the passes that write them nor their sizes have changed.
  // The graph is compiled again, in milliseconds as long as no shader changes. Throws as the constructor does, and then
  // everything stays as it was.
  void set(const std::vector<std::string>& values);

  // Fills an input of the graph itself ("radiance", "surface.position"), until it is filled again. `bytes` are those of
  // OutputData::bytes: texels or elements, tightly packed, in the format that the graph declares; of images with
  // "light": true, 32-bit floats in the units of the scene, whatever their format is. Light beyond the range of that
  // format becomes the brightest that fits. Waits for the device.
  // Throws Error(BadInput) for an input that the graph does not have, or another number of bytes.
  void setInput(const std::string& name, std::span<const std::byte> bytes);

  // Chooses what render() reads back: outputs of the graph ("radiance"), and ports of passes as they are right after
  // their pass ("eye:surface.normal"), which need not be outputs. FrameResult::outputs has them by these names. Of
  // an image with several mips or layers, a port has one: "atlas:maps@MIP.LAYER", by default 0.0. Empty for all outputs.
  // Throws Error(BadInput) for names that the graph does not have, ports that are not wired, and passes that do not run.
  void read(const std::vector<std::string>& names);

  // A floating-point or normalised image as read back. Throws Error(Usage) for one that was not read back and
  // Error(Internal) for an integer format.
  image::Image picture(const FrameResult& frame, const std::string& name) const;
  // What an element of a buffer consists of, by the name of its type (ResourceDesc::element), as the shaders of the
  // graph declare it. Empty for types that they know only as texels.
  std::vector<RecordField> fields(const std::string& element) const;
  std::map<std::string, ResourceDesc> inputs() const;  // what setInput() fills
  std::vector<std::string> outputs() const;            // of the graph
  std::string plan(PlanForm form) const;
  const std::string& passName(uint32_t pass) const;  // PassTiming::pass
  const std::shared_ptr<gpu::Device>& device() const;
  const Diagnostics& warnings() const;  // about the graph as it is now

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::graph
