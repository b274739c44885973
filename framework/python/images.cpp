// Pictures: reading and writing files, and comparing.
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cstring>

#include "fovea/compare.h"
#include "framework/python/arrays.h"
#include "framework/python/casters.h"
#include "framework/python/module.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;
using namespace image;

namespace {

using Picture = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Pictures = std::map<std::string, Picture>;

File fileOf(const Pictures& pictures, Metadata metadata, bool radiance) {
  File file;
  file.metadata = std::move(metadata);
  file.radiance = radiance;
  for (const auto& [name, array] : pictures) {
    Layer layer{name, {uint32_t(array.shape(1)), uint32_t(array.shape(0)), uint32_t(array.shape(2)), {}}};
    layer.image.data.assign(array.data(), array.data() + array.size());
    file.layers.push_back(std::move(layer));
  }
  return file;
}

std::map<std::string, std::map<std::string, double>> compareFiles(
    const File& image, const File& reference, const std::string& layer, std::optional<glm::vec2> gaze,
    std::optional<float> radius, std::optional<float> exposure, double pixelsPerDegree) {
  const PerRegion<Measures> measures =
      compare(image, reference, {layer, gaze, radius, exposure, pixelsPerDegree});
  const auto numbers = [](const Measures& m) {
    std::map<std::string, double> named = {{"pixels", double(m.pixels)}};
    for (const auto& [name, value] : namedMeasures(m)) named[name] = value;
    return named;
  };
  return {{"fovea", numbers(measures.fovea)},
          {"periphery", numbers(measures.periphery)},
          {"whole", numbers(measures.whole)}};
}

std::map<std::string, ReadArray> layersOf(nb::handle self) {
  std::map<std::string, ReadArray> arrays;
  for (const Layer& layer : nb::cast<const File&>(self).layers) {
    const size_t shape[] = {layer.image.height, layer.image.width, layer.image.channels};
    arrays.emplace(layer.name,
                   ReadArray(layer.image.data.data(), 3, shape, self, nullptr, nb::dtype<float>()));
  }
  return arrays;
}

}  // namespace

void addImages(nb::module_& module) {
  nb::class_<File>(module, "Pictures", "The layers of an image file.")
      .def(nb::new_(&fileOf), "layers"_a, "metadata"_a, "radiance"_a)
      .def_static(
          "read", [](const std::string& file) { return read(file); }, "file"_a,
          nb::call_guard<nb::gil_scoped_release>())
      .def(
          "write",
          [](const File& pictures, const std::string& file) {
            write(file, pictures.layers, pictures.metadata);
          },
          "file"_a, nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("layers", &layersOf,
                   nb::sig("def layers(self) -> dict[str, numpy.typing.NDArray[numpy.float32]]"),
                   "height x width x channels, float32, by name")
      .def_ro("metadata", &File::metadata);
  module.def("compare", &compareFiles, "image"_a, "reference"_a, "layer"_a, "gaze"_a.none(),
             "radius"_a.none(), "exposure"_a.none(), "pixels_per_degree"_a,
             nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace fovea::python
