// Steps of a pass: what they read and write, what they wait for, and that no hazard is left between them.
#include <gtest/gtest.h>

#include <map>

#include "framework/graph/steps/steps.h"
#include "framework/graph/verify/checker.h"
#include "tests/unit/random_graph.h"

namespace fovea::graph::test {
namespace {

using gpu::BindingKind;

// Shaders that exist only as the bindings that a step would find in them.
class FakeShaders {
 public:
  void add(const std::string& file, std::vector<gpu::ReflectedBinding> bindings) {
    auto shader = std::make_shared<gpu::CompiledShader>();
    shader->file = file;
    shader->reflection.bindings = std::move(bindings);
    shaders_[file] = shader;
  }
  ShaderLookup lookup() const {
    return [this](const std::string& file, const gpu::Defines&) { return shaders_.at(file); };
  }

 private:
  std::map<std::string, std::shared_ptr<const gpu::CompiledShader>> shaders_;
};

gpu::ReflectedBinding binding(const std::string& name, BindingKind kind, bool readOnly = false,
                              bool writeOnly = false) {
  gpu::ReflectedBinding b;
  b.name = name;
  b.kind = kind;
  b.readOnly = readOnly;
  b.writeOnly = writeOnly;
  return b;
}

// A pass with two buffers of its own, and the plan of its steps.
class Steps : public ::testing::Test {
 protected:
  Steps() : declaration_("stepped", "For tests") {
    const Usage both = Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite;
    declaration_.input("given", image2D(kColor), Usage::Sampled, "read");
    declaration_.output("made", buffer("uint", 4, 16), both, "made");
    declaration_.scratch("own", buffer("uint", 4, 16), both | Usage::Indirect, "own");
    declaration_.parameter("wide", flag(false), "a flag");
    shaders_.add("reads.comp", {binding("own", BindingKind::StorageBuffer, true),
                                binding("made", BindingKind::StorageBuffer, false, true)});
    shaders_.add("writes.comp", {binding("own", BindingKind::StorageBuffer, false, true)});
    shaders_.add("adds.comp", {binding("own", BindingKind::StorageBuffer)});
    shaders_.add("looks.comp", {binding("given", BindingKind::SampledImage)});
  }

  const std::vector<PlannedStep>& plan() {
    addBasicTypes(registry_);
    registry_.add(declaration_, nullptr);
    Diagnostics messages;
    graph_ = bindText(R"({"passes": {"source": {"type": "source"},
                                     "stepped": {"type": "stepped", "inputs": {"given": "source"}}},
                          "outputs": {"made": "stepped"}})",
                      registry_, messages);
    CompileOptions options;
    options.shaders = shaders_.lookup();
    plan_ = compile(graph_, options);
    return plan_.steps[1];
  }

  // What planning reports for a pass that is declared in a file, of which `place` stands in line 7.
  std::string reported(const std::string& place) {
    declaration_.places = std::make_shared<const std::map<std::string, SourceLocation>>(
        std::map<std::string, SourceLocation>{{place, {"stepped.pass.json", 7, 5}}});
    try {
      plan();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::BadInput);
      return error.what();
    }
    return "accepted";
  }

  FakeShaders shaders_;
  PassDeclaration declaration_;
  Registry registry_;
  std::shared_ptr<const BoundGraph> graph_;
  Plan plan_;
};

TEST_F(Steps, AReaderWaitsForTheWriter) {
  declaration_.step("writes.comp").threads(16);
  declaration_.step("reads.comp").threads(16);
  const auto& steps = plan();
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_FALSE(steps[0].before);
  EXPECT_EQ(steps[1].before.srcStage, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  EXPECT_EQ(steps[1].before.srcAccess, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  EXPECT_EQ(steps[1].before.dstStage, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  EXPECT_TRUE(checkPlan(plan_).empty());
}

TEST_F(Steps, AWriterWaitsForReadersWithoutFlushing) {
  declaration_.fill("own", 0);
  declaration_.step("reads.comp").threads(16);
  declaration_.step("writes.comp").threads(16);
  const auto& steps = plan();
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[1].before.srcStage, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT);
  EXPECT_EQ(steps[2].before.srcStage, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  EXPECT_EQ(steps[2].before.srcAccess, 0u);
}

TEST_F(Steps, ABindingWithoutQualifierBothReadsAndWrites) {
  declaration_.step("adds.comp").called("first").threads(16);
  declaration_.step("adds.comp").called("second").threads(16);
  const auto& steps = plan();
  ASSERT_EQ(steps[0].accesses.size(), 1u);
  EXPECT_TRUE(steps[0].accesses[0].reads);
  EXPECT_TRUE(steps[0].accesses[0].writes);
  EXPECT_TRUE(steps[1].before);
}

TEST_F(Steps, StepsThatRunTogetherDoNotWaitForEachOther) {
  declaration_.fill("own", 0);
  declaration_.step("adds.comp").called("first").threads(16);
  declaration_.step("adds.comp").called("second").threads(16).runTogether();
  declaration_.step("reads.comp").threads(16);
  const auto& steps = plan();
  EXPECT_TRUE(steps[1].before);
  EXPECT_FALSE(steps[2].before);
  EXPECT_TRUE(steps[3].before);
  EXPECT_TRUE(checkPlan(plan_).empty());
}

TEST_F(Steps, StepsOnDifferentResourcesDoNotWait) {
  declaration_.fill("own", 0);
  declaration_.fill("made", 0);
  declaration_.step("looks.comp").threads(16);
  for (const PlannedStep& step : plan()) EXPECT_FALSE(step.before);
}

TEST_F(Steps, AConditionLeavesAStepOut) {
  declaration_.step("writes.comp").when(parameter("wide")).threads(16);
  declaration_.step("looks.comp").when(wired("given")).threads(16);
  const auto& steps = plan();
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].step, 1u);
}

TEST_F(Steps, AnIndirectDispatchWaitsForItsBuffer) {
  declaration_.step("writes.comp").threads(16);
  declaration_.step("looks.comp").indirect("own");
  const auto& steps = plan();
  EXPECT_EQ(steps[1].before.dstStage, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  EXPECT_EQ(steps[1].before.dstAccess, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

// A step that draws the tiles of a mask of its own, of which its fragment shader knows nothing.
TEST_F(Steps, TilesAreDrawnAfterTheirMask) {
  declaration_.kind = PassKind::ComputeAndGraphics;
  declaration_.scratch("mask", image2D(VK_FORMAT_R8_UNORM, 2, 2), Usage::StorageRead | Usage::ColorAttachment,
                       "");
  declaration_.scratch("image", image2D(kColor), Usage::ColorAttachment, "drawn");
  shaders_.add("mask.frag", {});
  shaders_.add("draws.frag", {});
  declaration_.fullscreen("mask.frag", {"mask"});
  declaration_.fullscreen("draws.frag", {"image"}).tiles("mask");
  const auto& steps = plan();
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].before.srcAccess & VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
  EXPECT_NE(steps[1].before.dstStage & VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, 0u);
  EXPECT_NE(steps[1].before.dstAccess & VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0u);
  EXPECT_TRUE(checkPlan(plan_).empty());
}

TEST_F(Steps, ReadingWhatNothingWroteIsAnError) {
  declaration_.step("reads.comp").threads(16);
  try {
    plan();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(error.what()).find("step `reads` reads `own`, which no step before it has written"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Steps, InAFileABindingWithoutPortIsReportedThere) {
  shaders_.add("wrong.comp", {binding("givn", BindingKind::SampledImage)});
  declaration_.step("wrong.comp").threads(16);
  EXPECT_EQ(
      reported("steps.wrong"),
      "stepped.pass.json:7:5: error: pass `stepped` (stepped): step `wrong`: the shader wrong.comp binds "
      "`givn`, which is no port of the pass (at steps.wrong)\n  -> did you mean `given`?");
}

TEST_F(Steps, InAFileAPortWithoutBindingIsReportedThere) {
  declaration_.fill("made", 0);
  declaration_.fill("own", 0);
  EXPECT_EQ(
      reported("ports.given"),
      "stepped.pass.json:7:5: error: pass `stepped` (stepped): no step uses the port `given` (at ports.given)"
      "\n  -> bind it in a shader as `given`, or remove it");
}

TEST_F(Steps, InAFileABindingOfAnInputThatIsNotWiredIsReportedThere) {
  declaration_.input("more", image2D(kColor), Usage::Sampled, "read").makeOptional();
  shaders_.add("more.comp", {binding("more", BindingKind::SampledImage)});
  declaration_.step("more.comp").threads(16);
  EXPECT_NE(reported("steps.more")
                .find("7:5: error: pass `stepped` (stepped): step `more`: the shader more.comp binds "
                      "`more`, which is an input that is not wired"),
            std::string::npos);
}

TEST_F(Steps, AnExpressionThatOverflowsIsAnError) {
  const SizeExpr large = int64_t(1) << 40;
  declaration_.step("looks.comp").define("HUGE", large * large).threads(16);
  EXPECT_NE(
      reported("").find("`1099511627776 * 1099511627776` in one of its steps overflows or divides by zero"),
      std::string::npos);
}

// ---- Random passes -----------------------------------------------------------------------------------

gpu::ReflectedBinding randomBinding(const std::string& name, ResourceKind kind, Usage usage, bool mayWrite,
                                    Dice& dice) {
  if (any(usage, Usage::Sampled)) return binding(name, BindingKind::SampledImage);
  if (any(usage, Usage::Uniform)) return binding(name, BindingKind::UniformBuffer);
  if (any(usage, Usage::TexelRead)) return binding(name, BindingKind::UniformTexelBuffer);
  const uint32_t roll = mayWrite ? dice(3) : 0;  // 0: reads, 1: writes, 2: both
  return binding(name, kind == ResourceKind::Image ? BindingKind::StorageImage : BindingKind::StorageBuffer,
                 roll == 0, roll == 1);
}

// Up to six steps over the pass's ports, none of which reads memory that nothing wrote.
void addRandomSteps(PassDeclaration& d, FakeShaders& shaders, Dice& dice) {
  if (d.kind == PassKind::Host) return;
  std::set<std::string> written;
  const uint32_t count = dice(7);
  for (uint32_t i = 0; i < count; ++i) {
    const bool fullscreen =
        d.kind == PassKind::Graphics || (d.kind == PassKind::ComputeAndGraphics && dice.chance(40));
    const std::string file = fmt::format("{}_{}.{}", d.type, i, fullscreen ? "frag" : "comp");
    std::vector<gpu::ReflectedBinding> bindings;
    std::vector<std::string> targets, transfers;
    std::string indirect;
    for (const PortSpec& port : d.ports) {
      const Usage usage = port.members[0].usage;
      const ResourceKind kind = port.members[0].resource.kind;
      if (port.optional || dice.chance(50)) continue;
      const bool own = port.direction == Direction::Output || port.direction == Direction::Scratch;
      const bool readable = !own || port.lifetime != Lifetime::Transient || written.contains(port.name);
      if (any(usage, Usage::ColorAttachment)) {
        if (fullscreen) targets.push_back(port.name);
      } else if (any(usage, Usage::TransferWrite) && dice.chance(60)) {
        transfers.push_back(port.name);
      } else if (any(usage, Usage::Indirect) && readable && dice.chance(50)) {
        indirect = port.name;
      } else if (any(usage, Usage::StorageRead | Usage::StorageWrite | Usage::Sampled | Usage::Uniform |
                                Usage::TexelRead)) {
        gpu::ReflectedBinding b =
            randomBinding(port.name, kind, usage, any(usage, Usage::StorageWrite), dice);
        if (b.readOnly && !readable) b.readOnly = false, b.writeOnly = true;
        if (b.readOnly && !any(usage, Usage::StorageRead)) b.readOnly = false, b.writeOnly = true;
        if (!b.readOnly && any(usage, Usage::StorageWrite)) written.insert(port.name);
        bindings.push_back(b);
      }
    }
    for (const std::string& port : transfers) {
      const bool image = d.findPort(port)->members[0].resource.kind == ResourceKind::Image;
      (image ? d.clear(port, 0) : d.fill(port, 0)).called(fmt::format("transfer {} {}", i, port));
      written.insert(port);
    }
    shaders.add(file, bindings);
    StepSpec& step = fullscreen ? d.fullscreen(file, targets) : d.step(file);
    step.called(fmt::format("step {}", i));
    if (dice.chance(15)) step.runTogether();
    if (fullscreen || indirect.empty())
      step.threads(1);
    else
      step.indirect(indirect);
    for (const std::string& target : targets) written.insert(target);
  }
}

TEST(StepsProperty, RandomPassesAreFreeOfHazards) {
  uint32_t graphs = 0, steps = 0, waits = 0, removed = 0;
  for (uint32_t set = 0; set < 5; ++set) {
    Registry registry;
    FakeShaders shaders;
    Dice dice(7000 + set);
    const std::vector<RandomType> types = addRandomTypes(
        registry, 2000 + set, 40, [&](PassDeclaration& d) { addRandomSteps(d, shaders, dice); });
    for (uint32_t g = 0; g < 320; ++g) {
      std::shared_ptr<const BoundGraph> graph;
      Diagnostics messages;
      try {
        graph = bindText(randomGraph(types, set * 100000 + g), registry, messages);
      } catch (const Error&) {
        continue;  // plan_property_test.cpp looks at the reasons
      }
      ++graphs;
      CompileOptions options;
      options.shaders = shaders.lookup();
      Plan plan = compile(graph, options);
      const std::vector<std::string> problems = checkPlan(plan);
      ASSERT_TRUE(problems.empty()) << "set " << set << ", graph " << g << ":\n"
                                    << fmt::format("{}", fmt::join(problems, "\n"));
      // Without any one of its barriers, the plan has a hazard that the checker finds.
      for (std::vector<PlannedStep>& pass : plan.steps)
        for (PlannedStep& step : pass) {
          ++steps;
          if (!step.before) continue;
          ++waits;
          if (g % 8 != 0) continue;
          const Dependency kept = std::exchange(step.before, Dependency());
          EXPECT_FALSE(checkPlan(plan).empty()) << "set " << set << ", graph " << g;
          step.before = kept;
          ++removed;
        }
    }
  }
  EXPECT_GE(graphs, 1500u);
  EXPECT_GE(steps, 20000u);
  EXPECT_GE(waits, 5000u);
  EXPECT_GE(removed, 500u);
}

}  // namespace
}  // namespace fovea::graph::test
