// Sessions: a graph over a scene on a device.
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "fovea/session.h"
#include "framework/gpu/format.h"
#include "framework/python/arrays.h"
#include "framework/python/casters.h"
#include "framework/python/frames.h"
#include "framework/python/locks.h"
#include "framework/python/module.h"
#include "framework/python/raised.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Progress = std::function<bool(const std::string& pass, double share)>;
using Names = std::vector<std::string>;

// Whether a pass that runs long on the CPU should go on: Ctrl-C, an exception or False end it soon.
bool goOn(const Progress& progress, const std::string& pass, double share) {
  const nb::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) {
    keepRaised(nb::python_error());
    return false;
  }
  if (!progress) return true;
  try {
    return progress(pass, share);
  } catch (nb::python_error& error) {
    keepRaised(std::move(error));
    return false;
  }
}

class Session {
 public:
  Session(const graph::Document& graph, std::shared_ptr<const scene::Scene> scene, glm::uvec2 size,
          uint32_t seed, double frameRate, Names set, Names read, std::shared_ptr<Device> device,
          Progress progress)
      : scene_(std::move(scene)), device_(std::move(device)) {
    graph::SessionOptions options{.device = device_->gpu, .size = size, .seed = seed, .frameRate = frameRate};
    options.set = std::move(set), options.read = std::move(read);
    options.progress = [progress = std::move(progress)](const std::string& pass, double share) {
      return goOn(progress, pass, share);
    };
    compiling([&] { session_.emplace(graph, *scene_, options); });
  }
  // A pass in Python may happen to drop the last reference while its frame uses the device.
  ~Session() {
    std::optional<DeviceUse> use;
    if (device_->user != std::this_thread::get_id()) use.emplace(*device_);
    session_.reset();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::unique_ptr<Frame> render(const graph::FrameOptions& options) {
    auto frame = std::make_unique<Frame>();
    {
      const DeviceUse use(*device_);
      frame->result = session_->render(options);
    }
    rethrowRaised();
    for (const graph::PassTiming& pass : frame->result.passes) {
      Times times{session_->passName(pass.pass), pass.gpuMs, pass.cpuMs, {}};
      for (const graph::StepTiming& step : pass.steps) times.steps.emplace_back(step.name, step.gpuMs);
      frame->passes.push_back(std::move(times));
    }
    return frame;
  }

  void set(const Names& values) {
    compiling([&] { session_->set(values); });
  }
  void read(const Names& names) {
    compiling([&] { session_->read(names); });
  }
  void write(const std::string& name, nb::ndarray<nb::c_contig, nb::ro, nb::device::cpu> array) {
    const std::span bytes(static_cast<const std::byte*>(array.data()), array.nbytes());
    const DeviceUse use(*device_);
    session_->setInput(name, bytes);
  }

  const graph::Session& session() const { return *session_; }
  std::string deviceName() const { return gpu::nameOf(*device_->gpu); }

 private:
  template <class Work>
  void compiling(const Work& work) {
    const DeviceUse use(*device_);
    const std::lock_guard lock(registryMutex());
    work();
  }

  std::shared_ptr<const scene::Scene> scene_;
  std::shared_ptr<Device> device_;
  std::optional<graph::Session> session_;
};

// Name, offset in bytes, type of numpy and number of components of each field; the type is "" if it is no number.
using Fields = std::vector<std::tuple<std::string, uint32_t, std::string, uint32_t>>;

Fields fieldsOf(const Session& session, const std::string& element) {
  using Type = graph::RecordField::Type;
  Fields fields;
  for (const graph::RecordField& f : session.session().fields(element))
    fields.emplace_back(f.name, f.offset,
                        f.type == Type::Int     ? "int32"
                        : f.type == Type::Uint  ? "uint32"
                        : f.type == Type::Float ? "float32"
                                                : "",
                        f.type == Type::Other ? f.bytes : f.components);
  return fields;
}

}  // namespace

void addSessions(nb::module_& module) {
  nb::class_<Device>(module, "Device",
                     "A Vulkan device, which renderers may share; use `fovea.Renderer(device=..)`.")
      .def_static("open", &Device::open, "name"_a, "without"_a, nb::call_guard<nb::gil_scoped_release>())
      .def_static("close_all", &Device::closeAll, nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("name", [](const Device& d) { return gpu::nameOf(*d.gpu); });
  nb::class_<Session>(module, "Session", "A graph over a scene on a device; use `fovea.Renderer`.")
      .def(nb::init<const graph::Document&, std::shared_ptr<const scene::Scene>, glm::uvec2, uint32_t, double,
                    Names, Names, std::shared_ptr<Device>, Progress>(),
           "graph"_a, "scene"_a, "size"_a, "seed"_a, "frame_rate"_a, "set"_a, "read"_a, "device"_a,
           "progress"_a.none())
      .def(
          "render",
          [](Session& session, uint64_t index, std::optional<double> time,
             std::optional<scene::Camera> camera, std::optional<glm::vec2> gaze, bool cut, bool read) {
            return session.render({index, time, std::move(camera), gaze, cut, read});
          },
          "index"_a, "time"_a.none(), "camera"_a.none(), "gaze"_a.none(), "cut"_a, "read"_a)
      .def("set", &Session::set, "values"_a)
      .def("read", &Session::read, "names"_a)
      .def("write", &Session::write, "name"_a, "array"_a,
           nb::sig("def write(self, name: str, array: numpy.typing.NDArray[typing.Any]) -> None"))
      .def("fields", &fieldsOf, "element"_a)
      .def(
          "inputs",
          [](const Session& session) {
            std::map<std::string, std::pair<std::string, std::vector<size_t>>> inputs;
            for (const auto& [name, desc] : session.session().inputs()) {
              graph::ResourceDesc given = desc;
              if (desc.light != 0) given.format = gpu::floatFormat(gpu::formatInfo(desc.format).channels);
              inputs.emplace(name, std::pair(given.kind == graph::ResourceKind::Buffer ? "" : typeName(given),
                                             shapeOf(given)));
            }
            return inputs;
          },
          "The inputs of the graph: type of numpy and shape of each; of a buffer \"\" and its bytes.")
      .def("outputs", [](const Session& s) { return s.session().outputs(); })
      .def(
          "plan", [](const Session& s, graph::PlanForm form) { return s.session().plan(form); }, "form"_a)
      .def("warnings", [](const Session& s) { return s.session().warnings().list(); })
      .def_prop_ro("device", &Session::deviceName);
}

}  // namespace fovea::python
