#include "tests/support/graph_runner.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/shader/shader.h"
#include "framework/graph/pass/registry.h"
#include "framework/scene/frame.h"
#include "framework/session/test_device.h"
#include "places.h"

namespace fovea::test {

using namespace graph;

namespace {

class FillImage : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-fill", "Fills an image with key + frame number.");
    d.output("value", image(), Usage::StorageWrite, "the value");
    d.parameter("key", integer(1, 0, 1 << 30), "value of frame 0");
    return d;
  }
  void prepare(PrepareContext& context) override {
    addTestShaders(context);
    kernel_ = context.compute("fill_image.comp");
  }
  void record(RecordContext& context) override { context.use(kernel_).dispatchOver("value"); }

 private:
  Kernel kernel_;
};
FOVEA_PASS(FillImage);

}  // namespace

void addTestShaders(PrepareContext& context) {
  context.device().shaders().addSearchPath(FOVEA_TEST_DATA "/shaders");
}

Runner::Runner(const std::string& text, const CompileOptions& extra) {
  scene.materials.emplace_back();
  scene.cameras.emplace_back();
  geometry = scene::flatten(scene);
  gpuScene = std::make_unique<scene::GpuScene>(test::testDevice(), scene, geometry, 2);
  Diagnostics messages;
  const Description description = loadText(text, "test.json", {}, messages);
  Environment environment = deviceEnvironment(&test::testDevice());
  environment.views = {{"main", {16, 16}}};
  auto bound = std::make_shared<const BoundGraph>(bind(description, environment, messages));
  CompileOptions options = deviceCompileOptions(test::testDevice(), bound);
  options.alias = extra.alias;
  options.randomOrder = extra.randomOrder;
  plan = std::make_shared<const Plan>(compile(bound, options));
  ExecutorOptions executorOptions;
  for (const BoundOutput& output : bound->outputs) executorOptions.readback.push_back(output.name);
  executor =
      std::make_unique<Executor>(test::testDevice(), plan, Registry::global(), *gpuScene, executorOptions);
}

FrameResult Runner::frame(bool cameraCut) {
  scene::Frame f = scene::makeFrame(scene, geometry, {16, 16}, next++, 1);
  f.gpu = gpuScene.get();
  f.cameraCut = cameraCut;
  executor->submit(f, true);
  return *executor->next();
}

std::vector<uint32_t> words(const FrameResult& result, const std::string& output) {
  const auto& raw = result.outputs.at(output).bytes;
  std::vector<uint32_t> values(raw.size() / 4);
  std::memcpy(values.data(), raw.data(), raw.size());
  return values;
}

void expectAll(const FrameResult& result, const std::string& output, uint32_t expected) {
  for (uint32_t v : words(result, output)) ASSERT_EQ(v, expected) << output << " in frame " << result.frame;
}

}  // namespace fovea::test
