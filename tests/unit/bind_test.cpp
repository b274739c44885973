// Tests bind: parameters, ports, bundles, sizes, views, history and limits. Positions of errors are
// tested in located_errors_test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/gpu/format.h"
#include "framework/graph/verify/checker.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::HasSubstr;

Compiled bound(const std::string& text, const std::vector<Override>& overrides = {}) {
  return compileText(text, {}, {overrides, {}});
}

std::string errorOf(const std::string& text, const Environment* environment = nullptr) {
  const auto registry = basicRegistry();
  Environment env = environment ? *environment : basicEnvironment(*registry);
  env.registry = registry.get();
  Diagnostics messages;
  try {
    bind(loadText(text, "g.json", {}, messages), env, messages);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    return e.what();
  }
  return {};
}

TEST(Bind, ParametersHaveDefaultsAndConvert) {
  const Compiled c = bound(
      R"({"passes": {"a": {"type": "source", "params": {"radius": 1, "kernel": "clamp", "fast": true}}}, "outputs": {"o": "a"}})");
  const Parameters& p = c.graph->passes[0].parameters;
  EXPECT_EQ(p.integer("count"), 3);
  EXPECT_EQ(p.real("radius"), 1.0);  // a whole number where a real one is expected
  EXPECT_EQ(p.real("count"), 3.0);
  EXPECT_EQ(p.text("kernel"), "clamp");
  EXPECT_TRUE(p.flag("fast"));
  EXPECT_EQ(p.text("label"), "none");
  EXPECT_EQ(p.find("nothing"), nullptr);
  EXPECT_THROW(p.integer("nothing"), Error);
  EXPECT_THROW(p.integer("radius"), Error);
}

TEST(Bind, OverridesAreTypedByTheDeclaration) {
  const Compiled c = bound(
      R"({"passes": {"a": {"type": "source", "params": {"count": 5}}}, "outputs": {"o": "a"}})",
      {{"a.count", "7"}, {"a.radius", "0.25"}, {"a.kernel", "clamp"}, {"a.fast", "true"}, {"a.label", "12"}});
  const Parameters& p = c.graph->passes[0].parameters;
  EXPECT_EQ(p.integer("count"), 7);
  EXPECT_EQ(p.real("radius"), 0.25);
  EXPECT_EQ(p.text("kernel"), "clamp");
  EXPECT_TRUE(p.flag("fast"));
  EXPECT_EQ(p.text("label"), "12");
}

// A pass that updates a bundle may list only some of its members, in an order of its own.
TEST(Bind, MembersAreReachedThroughAnUpdateOfSomeOfThem) {
  const Compiled c = bound(R"({"passes": {
    "d": {"type": "draw"},
    "b": {"type": "bend", "inputs": {"gbuffer": "d"}},
    "f": {"type": "filter", "inputs": {"image": "b.gbuffer.normal"}}},
    "outputs": {"n": "b.gbuffer.normal", "f": "f"}})");
  const uint32_t normal = c.resource("d.gbuffer.normal");
  EXPECT_EQ(c.graph->passes[c.pass("b")].accesses[0].resource, normal);
  EXPECT_EQ(c.graph->passes[c.pass("f")].accesses[0].resource, normal);
  ASSERT_EQ(c.graph->outputs.size(), 2u);
  EXPECT_EQ(c.graph->outputs[0].resource, normal);
}

TEST(Bind, OnePortNeedsNoNameAndMembersAreReached) {
  const Compiled c = bound(R"({"passes": {
    "d": {"type": "draw"},
    "f": {"type": "filter", "inputs": {"image": "d.normal"}},
    "g": {"type": "filter", "inputs": {"image": "d.gbuffer.normal"}},
    "s": {"type": "shade", "inputs": {"gbuffer": "d"}},
    "t": {"type": "shade", "inputs": {"gbuffer": "d.gbuffer"}},
    "e": {"type": "emit"},
    "m": {"type": "atlas", "inputs": {"vpls": "e"}}},
    "outputs": {"a": "f", "b": "g", "c": "s", "d": "t", "m": "m", "g": "d"}})");
  const uint32_t normal = c.resource("d.gbuffer.normal");
  EXPECT_EQ(c.graph->passes[c.pass("f")].accesses[0].resource, normal);
  EXPECT_EQ(c.graph->passes[c.pass("g")].accesses[0].resource, normal);
  // A reader of a bundle touches only the members it names.
  const auto& shade = c.graph->passes[c.pass("s")].accesses;
  ASSERT_EQ(shade.size(), 3u);  // two members and its output; the optional lights are open
  EXPECT_EQ(shade[0].resource, c.resource("d.gbuffer.position"));
  EXPECT_EQ(shade[1].resource, c.resource("d.gbuffer.depth"));
  EXPECT_EQ(shade[1].member, 1u);
  // Bundles are written out among the outputs.
  std::vector<std::string> names;
  for (const BoundOutput& o : c.graph->outputs) names.push_back(o.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c", "d", "m", "g.position", "g.normal", "g.depth"}));
}

TEST(Bind, SizesFollowFromViewsParametersAndInputs) {
  const Compiled c = bound(R"({"passes": {
    "a": {"type": "draw"}, "l": {"type": "draw", "view": "left"},
    "e": {"type": "emit", "params": {"vpl_count": 50}},
    "m": {"type": "atlas", "params": {"map_size": 32}, "inputs": {"vpls": "e"}},
    "h": {"type": "half", "inputs": {"image": "l.normal"}},
    "q": {"type": "half", "inputs": {"image": "h"}},
    "r": {"type": "half", "inputs": {"image": "q"}},
    "z": {"type": "half", "inputs": {"image": "z2@previous"}}, "z2": {"type": "half", "inputs": {"image": "r"}}},
    "outputs": {"a": "a", "m": "m", "r": "r", "z": "z"}})");
  auto size = [&](const char* name) {
    const ResourceDesc& d = c.graph->resources[c.resource(name)].desc;
    return fmt::format("{}x{}x{}", d.width, d.height, d.layers);
  };
  EXPECT_EQ(size("a.gbuffer.position"), "64x32x1");
  EXPECT_EQ(size("l.gbuffer.position"), "16x16x1");
  EXPECT_EQ(size("m.maps"), "32x32x50");
  EXPECT_EQ(size("h.small"), "8x8x1");
  EXPECT_EQ(size("r.small"), "2x2x1");
  EXPECT_EQ(size("z.small"), "1x1x1");  // through a history edge, declared later
  EXPECT_EQ(c.graph->resources[c.resource("e.paths")].desc.count, 100u);
  EXPECT_EQ(c.graph->views, (std::vector<std::string>{"main", "left"}));
  EXPECT_EQ(c.graph->passes[c.pass("l")].view, 1u);
}

// An input that a parameter makes unnecessary is left open, and what only it needs does not run. Its wire is checked.
TEST(Bind, InputsUnderACondition) {
  const std::shared_ptr<Registry> registry = basicRegistry();
  PassDeclaration d("mix", "Reads a second image if `fast` is off");
  d.input("image", image2D(kColor), Usage::Sampled, "read");
  d.input("more", image2D(kColor), Usage::Sampled, "read, too").when(!parameter("fast"));
  d.output("mixed", image2D(kColor), Usage::StorageWrite, "made");
  d.parameter("fast", flag(false), "saves work");
  registry->add(d, nullptr);
  const auto bindWith = [&](const char* fast, const char* wire, Diagnostics& messages) {
    return bindText(fmt::format(R"({{"passes": {{
      "s": {{"type": "source"}}, "f": {{"type": "filter", "inputs": {{"image": "s"}}}},
      "m": {{"type": "mix", "params": {{"fast": {}}}, "inputs": {{"image": "s", "more": "{}"}}}}}},
      "outputs": {{"o": "m"}}}})",
                                fast, wire),
                    *registry, messages);
  };
  Diagnostics messages;
  const auto all = bindWith("false", "f", messages), some = bindWith("true", "f", messages);
  EXPECT_EQ(all->passes[2].accesses.size(), 3u);
  EXPECT_EQ(some->passes[2].accesses.size(), 2u);
  EXPECT_TRUE(compile(all, {}).passLive[1]);
  EXPECT_FALSE(compile(some, {}).passLive[1]);
  Diagnostics warnings;
  warnAboutPlan(compile(some, {}), warnings);
  EXPECT_TRUE(warnings.list().empty()) << "a parameter spares the pass, so that it is no mistake";
  const auto kept = bindWith("true", "f@previous", messages);
  for (const BoundResource& r : kept->resources) EXPECT_FALSE(r.history) << r.name;
  EXPECT_THROW(bindWith("true", "nothing", messages), Error);
}

TEST(Bind, QuantitiesOfTheScene) {
  Registry registry;
  PassDeclaration d("count", "Counts");
  d.output("items",
           buffer("Item", 4, environment("scene.triangles") * SizeExpr(2) + environment("scene.unknown")),
           Usage::StorageWrite, "made");
  registry.add(d, nullptr);
  Environment env = basicEnvironment(registry);
  env.quantities = {{"scene.triangles", 21}};
  Diagnostics messages;
  const BoundGraph g =
      bind(loadText(R"({"passes": {"c": {"type": "count"}}, "outputs": {"o": "c"}})", "g.json", {}, messages),
           env, messages);
  EXPECT_EQ(g.resources[0].desc.count, 43u);
}

// Of a parameter of the graph, of a pass or of a sub-graph. What --set says counts instead.
TEST(Bind, TextsOfTheScene) {
  const auto registry = basicRegistry();
  Environment env = basicEnvironment(*registry);
  env.texts = {{"scene.kernel", "clamp"}};
  const std::string text = R"({"parameters": {"kernel": "$scene.kernel"}, "passes": {
      "a": {"type": "source", "params": {"kernel": "$kernel", "label": "$$scene.kernel"}},
      "b": {"type": "source", "params": {"kernel": "$scene.kernel"}}}, "outputs": {"o": "a", "p": "b"}})";
  const auto kernels = [&](const LoadOptions& options) {
    Diagnostics messages;
    const BoundGraph g = bind(loadText(text, "g.json", options, messages), env, messages);
    EXPECT_EQ(g.passes[0].parameters.text("label"), "$scene.kernel");
    return g.passes[0].parameters.text("kernel") + " " + g.passes[1].parameters.text("kernel");
  };
  EXPECT_EQ(kernels({}), "clamp clamp");
  EXPECT_EQ(kernels({{{"kernel", "disc"}}, {}}), "disc clamp");
  env.texts = {{"scene.kernels", "clamp"}};
  Diagnostics messages;
  EXPECT_THROW(bind(loadText(text, "g.json", {}, messages), env, messages), Error);
  EXPECT_THAT(messages.format(),
              HasSubstr("parameter `kernel`: expected one of disc, clamp, found `$scene.kernel`"));
}

// The scene says which of several types a pass has, unless --set does.
TEST(Bind, TypesByTextsOfTheScene) {
  auto registry = basicRegistry();
  for (const char* type : {"trace-lines", "trace-cones"}) {
    PassDeclaration d(type, "Traces");
    d.output("hits", buffer("Hit", 4), Usage::StorageWrite, "made");
    registry->add(d, nullptr);
  }
  Environment env = basicEnvironment(*registry);
  const auto typeOf = [&](const std::string& scene, const LoadOptions& options) {
    env.texts = {{"scene.paths", scene}};
    Diagnostics messages;
    const std::string text = R"({"parameters": {"paths": "$scene.paths"},
        "passes": {"t": {"type": "trace-$paths"}}, "outputs": {"o": "t"}})";
    return bind(loadText(text, "g.json", options, messages), env, messages).passes[0].declaration->type;
  };
  EXPECT_EQ(typeOf("lines", {}), "trace-lines");
  EXPECT_EQ(typeOf("cones", {}), "trace-cones");
  EXPECT_EQ(typeOf("cones", {{{"paths", "lines"}}, {}}), "trace-lines");
  EXPECT_THROW(typeOf("moon", {}), Error);
}

TEST(Bind, AccessesSayWhatIsReadAndWritten) {
  const Compiled c = bound(R"({"passes": {
    "a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a"}},
    "k": {"type": "keep", "inputs": {"image": "u"}},
    "b": {"type": "blend", "inputs": {"a": "k", "b": "b@previous"}}}, "outputs": {"o": "b"}})");
  auto access = [&](const char* pass, size_t i) -> const Access& {
    return c.graph->passes[c.pass(pass)].accesses[i];
  };
  EXPECT_TRUE(access("a", 0).writes && !access("a", 0).reads);
  EXPECT_TRUE(access("u", 0).writes && access("u", 0).reads);
  EXPECT_TRUE(access("k", 1).writes && access("k", 1).reads);  // kept: what was there matters
  EXPECT_EQ(access("k", 1).version, 1u);
  EXPECT_TRUE(access("b", 1).previous && access("b", 1).reads);
  EXPECT_EQ(access("b", 1).resource, c.resource("b.image"));
  EXPECT_TRUE(c.graph->resources[c.resource("b.image")].history);
  EXPECT_FALSE(c.graph->resources[c.resource("a.image")].history);
  EXPECT_EQ(c.graph->resources[c.resource("k.sum")].lifetime, Lifetime::View);
  EXPECT_EQ(c.graph->resources[c.resource("a.image")].usage,
            uint32_t(Usage::StorageRead | Usage::StorageWrite | Usage::Sampled));
}

TEST(Bind, ExternalInputs) {
  const Compiled c = bound(
      R"({"inputs": {"radiance": {"format": "rgba16f"}, "small": {"format": "rgba16f", "width": 8, "height": 4},
      "gbuffer": {"bundle": "gbuffer", "members": {"position": {"format": "rgba32f"}, "depth": {"format": "d32f"}}},
      "vpls": {"element": "Vpl", "stride": 64, "count": 5}},
    "passes": {"b": {"type": "blend", "inputs": {"a": "inputs.radiance", "b": "inputs.small"}},
               "s": {"type": "shade", "inputs": {"gbuffer": "inputs.gbuffer", "vpls": "inputs.vpls"}}},
    "outputs": {"o": "b", "s": "s"}})");
  const BoundResource& radiance = c.graph->resources[c.resource("radiance")];
  EXPECT_TRUE(radiance.external);
  EXPECT_EQ(radiance.desc.width, 64u);  // the view's size
  EXPECT_EQ(c.graph->resources[c.resource("small")].desc.width, 8u);
  EXPECT_EQ(c.graph->resources[c.resource("gbuffer.depth")].desc.format, kDepth);
  EXPECT_EQ(c.graph->resources[c.resource("vpls")].desc.count, 5u);
  EXPECT_TRUE(checkPlan(c.plan).empty());
}

TEST(Bind, FloatInputsTakeAnyFloatFormatButNoIntegers) {
  for (const gpu::FormatInfo& format : gpu::formats()) {
    if (format.depth) continue;
    Registry registry;
    PassDeclaration make("make", "Makes"), any("any", "Reads");
    make.output("image", image2D(format.format), Usage::StorageWrite, "made");
    any.input("image", image2D(), Usage::Sampled, "read");
    any.output("out", image2D(kColor), Usage::StorageWrite, "made");
    for (const PassDeclaration& d : {make, any}) registry.add(d, nullptr);
    const char* text =
        R"({"passes": {"m": {"type": "make"}, "r": {"type": "any", "inputs": {"image": "m"}}}, "outputs": {"o": "r"}})";
    Diagnostics messages;
    const std::string_view name = format.name;
    if (!name.ends_with("i")) {
      EXPECT_NO_THROW(bindText(text, registry, messages)) << name;
      continue;
    }
    EXPECT_THROW(bindText(text, registry, messages), Error) << name;
    EXPECT_THAT(messages.format(),
                HasSubstr(fmt::format(
                    "`image` wants an image of floating-point texels, but `m` is an image of {}", name)));
  }
}

TEST(Bind, DeviceLimitsNameThePassTheLimitAndWhatToChange) {
  Environment env;
  env.views = {{"main", {64, 64}}};
  env.maxImageArrayLayers = 2048;
  env.maxImageDimension2D = 4096;
  env.maxStorageBufferRange = 1 << 20;
  EXPECT_THAT(
      errorOf(R"({"passes": {"e": {"type": "emit", "params": {"vpl_count": 2100}},
    "shadow-atlas": {"type": "atlas", "inputs": {"vpls": "e"}}}, "outputs": {"o": "shadow-atlas"}})",
              &env),
      HasSubstr(
          "pass `shadow-atlas`: `maps`: 2100 layers of 128x128 exceed this device's maxImageArrayLayers 2048 "
          "(at passes.e.params.vpl_count)\n  -> lower what it follows from: `vpl_count`"));
  EXPECT_THAT(
      errorOf(
          R"({"passes": {"e": {"type": "emit", "params": {"vpl_count": 100000}}}, "outputs": {"o": "e"}})",
          &env),
      HasSubstr("pass `e`: `vpls`: 100000 elements of 64 bytes exceed this device's maxStorageBufferRange "
                "1048576"));
  env.views = {{"main", {5000, 64}}};
  EXPECT_THAT(errorOf(R"({"passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})", &env),
              HasSubstr("pass `a`: `image`: 5000x64 exceeds this device's maxImageDimension2D 4096"));
}

TEST(Bind, AbsurdSizesAreRefusedWithoutKnowingTheDevice) {
  EXPECT_THAT(
      errorOf(R"({"inputs": {"v": {"element": "Vpl", "stride": 64, "count": 2147483648}}, "passes": {
    "m": {"type": "atlas", "inputs": {"vpls": "inputs.v"}}}, "outputs": {"o": "m"}})"),
      HasSubstr("the number of layers of `maps`, vpls.count, is 2147483648, it must be from 1 to 16777216"));
  EXPECT_THAT(errorOf(R"({"inputs": {"v": {"element": "Vpl", "stride": 64, "count": 16000000}}, "passes": {
    "m": {"type": "atlas", "inputs": {"vpls": "inputs.v"}}}, "outputs": {"o": "m"}})"),
              HasSubstr("128x128x1 with 16000000 layers is more than any device holds"));
  EXPECT_THAT(
      errorOf(R"({"inputs": {"v": {"element": "Vpl", "stride": 2147483647, "count": 2147483648}}, "passes": {
    "s": {"type": "source"}}, "outputs": {"o": "s"}})"),
      HasSubstr("this is more than any device holds (at inputs.v)"));
}

TEST(Bind, HashesTellGraphsApart) {
  const char* base =
      R"({"parameters": {"n": 3}, "passes": {"a": {"type": "source", "params": {"count": "$n"}}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})";
  const uint64_t hash = bound(base).graph->hash;
  EXPECT_EQ(hash, bound(base).graph->hash);
  EXPECT_NE(hash, bound(base, {{"n", "4"}}).graph->hash);
  EXPECT_NE(hash, bound(base, {{"a.kernel", "clamp"}}).graph->hash);
  EXPECT_NE(
      hash,
      bound(
          R"({"passes": {"a": {"type": "source"}, "b": {"type": "storage-filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})")
          .graph->hash);
  EXPECT_NE(
      hash,
      bound(
          R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b", "p": "a"}})")
          .graph->hash);
}

TEST(Bind, PlansAreCachedByWhatTheyCameFrom) {
  const Compiled c = bound(
      R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})");
  PlanCache cache;
  const auto first = cache.compile(c.graph);
  EXPECT_EQ(cache.compile(c.graph), first);
  EXPECT_EQ(cache.hits(), 1u);
  CompileOptions options;
  options.memory = [](uint32_t) { return MemoryNeed{4096, 256, 1}; };
  const auto other = cache.compile(c.graph, options);
  EXPECT_NE(other, first);
  EXPECT_EQ(cache.compile(c.graph, options), other);
  options.alias = false;
  EXPECT_NE(cache.compile(c.graph, options), other);
  for (uint64_t size = 1; size < 20; ++size) {
    options.memory = [size](uint32_t) { return MemoryNeed{4096 * size, 256, 1}; };
    cache.compile(c.graph, options);
  }
  EXPECT_LE(cache.size(), 8u);
}

TEST(Bind, CompilingTheSameTwiceGivesTheSamePlan) {
  const char* text =
      R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})";
  const Compiled x = bound(text), y = bound(text);
  EXPECT_EQ(x.plan.hash, y.plan.hash);
  EXPECT_EQ(x.order(), y.order());
}

TEST(Bind, WarnsAboutPassesThatDoNotRun) {
  Compiled c =
      bound(R"({"passes": {"a": {"type": "source"}, "b": {"type": "source"}}, "outputs": {"o": "b"}})");
  warnAboutPlan(c.plan, c.messages);
  EXPECT_EQ(c.messages.format(),
            "warning: pass `a` does not run: nothing needs what it makes (at passes.a)\n"
            "  -> wire one of its outputs, or remove it");
}

// ---- Declarations -----------------------------------------------------------------------------------------

TEST(SizeExpression, Prints) {
  EXPECT_EQ(ceilDiv(viewWidth(), 4).print(), "view.width / 4");
  EXPECT_EQ(((viewWidth() + 1) * parameter("n")).print(), "(view.width + 1) * n");
  EXPECT_EQ((viewWidth() - (viewHeight() - 1)).print(), "view.width - (view.height - 1)");
  EXPECT_EQ(max(widthOf("gbuffer.position"), countOf("vpls") * 2).print(),
            "max(gbuffer.position.width, vpls.count * 2)");
  EXPECT_EQ(ceilDiv(viewWidth(), parameter("a") * parameter("b")).print(), "view.width / (a * b)");
  EXPECT_EQ(min(environment("scene.lights"), 7).print(), "min(scene.lights, 7)");
  EXPECT_EQ(SizeExpr().print(), "1");
}

TEST(ShaderNames, AreCamelCase) {
  EXPECT_EQ(shaderName("gbuffer.position"), "gbufferPosition");
  EXPECT_EQ(shaderName("vpl_count"), "vplCount");
  EXPECT_EQ(shaderName("a_b_c.d_e"), "aBCDE");
  EXPECT_EQ(shaderName("radiance"), "radiance");
  EXPECT_EQ(shaderName("map_2d"), "map2d");
}

std::string refusal(const PassDeclaration& d) {
  Registry registry;
  try {
    registry.add(d, nullptr);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::Internal);
    return e.what();
  }
  return {};
}

TEST(Declarations, ThatContradictThemselvesAreRefused) {
  auto with = [](auto change) {
    PassDeclaration d("pass", "doc");
    change(d);
    return refusal(d);
  };
  const ResourceSpec image = image2D(kColor);
  EXPECT_EQ(with([&](PassDeclaration& d) { d.output("a", image, Usage::StorageWrite, ""); }), "");
  EXPECT_THAT(with([&](PassDeclaration& d) { d.type = "Bad Name"; }), HasSubstr("not in lower case"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.doc = ""; }), HasSubstr("has no doc"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.input("a", image, Usage::Sampled, "");
                d.input("a", image, Usage::Sampled, "");
              }),
              HasSubstr("port `a` is declared twice"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.input("a", image, Usage::StorageWrite, ""); }),
              HasSubstr("an input with a writing usage"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.output("a", image, Usage::Sampled, ""); }),
              HasSubstr("nothing writes it"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.output("a", image, Usage::ColorAttachment, ""); }),
              HasSubstr("no attachments"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.input("a", image, Usage::Uniform, ""); }),
              HasSubstr("an image cannot have"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.input("a", buffer("T", 4), Usage::Sampled, ""); }),
              HasSubstr("a buffer cannot have"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.output("a", image2D(), Usage::StorageWrite, ""); }),
              HasSubstr("needs a format"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.output("a", image2D(VK_FORMAT_D32_SFLOAT_S8_UINT), Usage::TransferWrite, "");
              }),
              HasSubstr("port `a`: VkFormat 130 is not one of fovea's formats"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.input("a", buffer("T", 0), Usage::StorageRead, ""); }),
              HasSubstr("needs a stride"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.input("a", image, Usage::HostRead, ""); }),
              HasSubstr("for host passes"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.output("a", image2D(kColor, parameter("n"), 1), Usage::StorageWrite, "");
              }),
              HasSubstr("is over `n`, which is no whole-number parameter"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.output("a", image2D(kColor, widthOf("b"), 1), Usage::StorageWrite, "");
              }),
              HasSubstr("is over `b`, which is no input"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.input("b", buffer("T", 4), Usage::StorageRead, "");
                d.output("a", image2D(kColor, widthOf("b"), 1), Usage::StorageWrite, "");
              }),
              HasSubstr("asks `b` for what a buffer does not have"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.parameter("n", integer(5, 6, 9), "doc"); }),
              HasSubstr("the default 5 is outside 6 to 9"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.parameter("n", choice("a", {"b"}), "doc"); }),
              HasSubstr("none of its choices"));
  EXPECT_THAT(with([&](PassDeclaration& d) { d.parameter("n", real(1, 0, 2), ""); }),
              HasSubstr("has no doc"));
  EXPECT_THAT(
      with([&](PassDeclaration& d) { d.parameter("n", flag(true), "x").parameter("n", flag(true), "x"); }),
      HasSubstr("declared twice"));
  EXPECT_THAT(with([&](PassDeclaration& d) {
                d.input("a_b", image, Usage::Sampled, "");
                d.input("a", "bundle", {member("b", image, Usage::Sampled)}, "");
              }),
              HasSubstr("the same name in shaders"));
}

TEST(Registry, RefusesTheSameTypeTwiceAndSorts) {
  Registry registry;
  registry.add(PassDeclaration("b", "doc"), nullptr);
  registry.add(PassDeclaration("a", "doc"), nullptr);
  EXPECT_THROW(registry.add(PassDeclaration("a", "doc"), nullptr), Error);
  EXPECT_EQ(registry.types(), (std::vector<std::string>{"a", "b"}));
  EXPECT_NE(registry.find("a"), nullptr);
  EXPECT_EQ(registry.find("c"), nullptr);
  EXPECT_THROW(registry.create("c"), Error);
}

TEST(Registry, PluginsThatCannotBeLoaded) {
  Registry registry;
  EXPECT_THROW(registry.loadPlugin("/nowhere/plugin.so"), Error);
  TempFolder folder;
  try {
    registry.loadPlugin(folder.write("text.so", "no library"));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_THAT(e.what(), HasSubstr("cannot load plug-in"));
  }
}

}  // namespace
}  // namespace fovea::graph::test
