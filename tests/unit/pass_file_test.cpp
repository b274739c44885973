// Passes declared in files: what a file means, and where its mistakes are reported.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "framework/graph/pass/expression.h"
#include "framework/graph/pass/pass_file.h"
#include "framework/graph/report/schema.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

namespace fs = std::filesystem;

// ---- Expressions -------------------------------------------------------------------------------------

std::string printed(const std::string& text) {
  ExpressionError error;
  const SizeExpr value = parseExpression(text, error);
  return error.message.empty() ? value.print()
                               : "error at " + std::to_string(error.column) + ": " + error.message;
}

TEST(Expression, PrintsWhatItReads) {
  for (const char* text :
       {"7", "radius", "view.width / 2", "picture.width + 1", "radius * 2 + 1", "max(a, b * 2)",
        "wired(direct)", "read(image)", "gbuffer.position.height", "scene.triangles", "cells.count / 64",
        "kernel == disc", "(a + b) * 2", "a + 1 <= b.count", "(a <= b) * wired(c)", "same(a, b.width * 2)"})
    EXPECT_EQ(printed(text), text);
}

TEST(Expression, ConditionsAreNumbers) {
  EXPECT_EQ(printed("!fast"), "1 - fast");
  EXPECT_EQ(printed("wired(a) && fast"), "wired(a) * fast");
  EXPECT_EQ(printed("wired(a) || fast"), "max(wired(a), fast)");
  EXPECT_EQ(printed("strategy == importance-area"), "strategy == importance-area");
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(printed(""), "error at 0: the expression ends where a value is expected");
  EXPECT_EQ(printed("1 +"), "error at 3: the expression ends where a value is expected");
  EXPECT_EQ(printed("2 ? 3"), "error at 2: unexpected `?`");
  EXPECT_EQ(printed("log(2)"),
            "error at 4: there is no function `log`; there are min, max, same, wired and read");
  EXPECT_EQ(printed("image.size"),
            "error at 10: `image` has no `size`; a port has width, height, layers or count");
  EXPECT_EQ(printed("min(1 2)"), "error at 6: expected `,`");
  EXPECT_EQ(printed("99999999999999999999"), "error at 0: the number is too large");
  EXPECT_NE(printed(std::string(5000, '(')).find("nested too deeply"), std::string::npos);
  EXPECT_NE(printed(std::string(5000, '!')).find("nested too deeply"), std::string::npos);
}

// ---- Files -------------------------------------------------------------------------------------------

class PassFiles : public ::testing::Test {
 protected:
  PassFiles() : folder_(fs::temp_directory_path() / ("fovea_pass_files_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~PassFiles() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  // What adding the folder reports, without the folder's name; empty if all is well.
  std::string added() {
    try {
      registry_.addFolder(folder_);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::BadInput);
      std::string text = error.what();
      const std::string prefix = folder_.string() + "/";
      for (size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return {};
  }
  // The same for a single file.
  std::string reported(const std::string& text) {
    write("blur.pass.json", text);
    return added();
  }
  void expectReport(const std::string& text, const std::string& message) {
    const std::string report = reported(text);
    EXPECT_NE(report.find(message), std::string::npos) << report;
  }

  fs::path folder_;
  Registry registry_;
};

const char* const kBlur = R"json({
  "doc": "blurs a picture",
  "inputs": { "picture": "the picture", "depth": { "doc": "distances", "optional": true } },
  "outputs": { "image": { "doc": "blurred", "format": "rgba16f", "width": "picture.width", "height": "picture.height" } },
  "scratch": { "rows": { "doc": "blurred along x", "format": "rgba16f" } },
  "params": { "radius": { "doc": "radius", "default": 2, "min": 1, "max": 9, "unit": "px" },
              "kernel": { "doc": "weights", "default": "box", "choices": ["box", "tent"] } },
  "counters": { "pixels": "pixels blurred" },
  "steps": [
    { "shader": "rows.comp", "over": "rows", "define": { "DEPTH": "wired(depth)", "RADIUS": "radius" } },
    { "name": "columns", "shader": "columns.comp", "over": "image", "when": "kernel == tent" }
  ]
})json";

TEST_F(PassFiles, DeclareAPass) {
  EXPECT_EQ(reported(kBlur), "");
  const PassDeclaration* d = registry_.find("blur");
  ASSERT_NE(d, nullptr);
  EXPECT_EQ(d->doc, "blurs a picture");
  EXPECT_EQ(d->kind, PassKind::Compute);
  ASSERT_EQ(d->ports.size(), 4u);
  EXPECT_EQ(d->findPort("picture")->members[0].usage, Usage::Sampled);
  EXPECT_TRUE(d->findPort("depth")->optional);
  EXPECT_EQ(d->findPort("image")->members[0].resource.width.print(), "picture.width");
  EXPECT_TRUE(any(d->findPort("rows")->members[0].usage, Usage::StorageWrite));
  EXPECT_TRUE(any(d->findPort("rows")->members[0].usage, Usage::Sampled));
  ASSERT_EQ(d->parameters.size(), 2u);
  EXPECT_EQ(d->parameters[0].type, ParameterSpec::Type::Int);
  EXPECT_EQ(d->parameters[0].max, 9);
  EXPECT_EQ(d->parameters[1].type, ParameterSpec::Type::Choice);
  ASSERT_EQ(d->steps.size(), 2u);
  EXPECT_EQ(d->steps[0].name, "rows");
  EXPECT_EQ(d->steps[0].shader, (folder_ / "rows.comp").string());
  EXPECT_EQ(d->steps[1].condition.print(), "kernel == tent");
  EXPECT_NE(registry_.create("blur"), nullptr);
}

// 1.0 is a whole number wherever one is expected, but as a default it declares a real parameter.
TEST_F(PassFiles, WholeNumbersInEverySpelling) {
  EXPECT_EQ(
      reported(
          R"({"doc": "x", "outputs": {"image": {"doc": "x", "format": "rgba8", "width": 8.0, "height": 8e0}},
      "params": {"count": {"doc": "x", "default": 2, "min": 1.0, "max": 9e0}, "share": {"doc": "x", "default": 1.0}},
      "steps": [{"shader": "a.comp", "over": "image"}]})"),
      "");
  const PassDeclaration* d = registry_.find("blur");
  ASSERT_NE(d, nullptr);
  EXPECT_EQ(d->findPort("image")->members[0].resource.width.print(), "8");
  EXPECT_EQ(d->parameters[0].type, ParameterSpec::Type::Int);
  EXPECT_EQ(d->parameters[1].type, ParameterSpec::Type::Real);
}

TEST_F(PassFiles, InputsUnderACondition) {
  const auto file = [](const char* condition) {
    return fmt::format(R"({{"doc": "x", "inputs": {{"a": {{"doc": "x", "when": "{}"}}}},
      "outputs": {{"image": {{"doc": "x", "format": "rgba8"}}}}, "params": {{"fast": {{"doc": "x", "default": true}}}},
      "steps": [{{"shader": "a.comp", "over": "image"}}]}})",
                       condition);
  };
  expectReport(file("wired(a)"), "the condition `wired(a)` is not over");
  expectReport(file("slow"), "the condition `slow` is not over");
  expectReport(file("image.width"), "the condition `image.width` is not over");
}

// A pass that draws the tiles of `mask`, which is an input with these properties.
std::string tiledPass(const char* mask, const char* step) {
  return fmt::format(R"({{"doc": "x", "inputs": {{"mask": {{"doc": "x", {}}}}},
 "outputs": {{"image": {{"doc": "x", "format": "rgba8"}}}}, "steps": [
 {}]}})",
                     mask, step);
}

const char* const kTiledStep = R"({"shader": "a.frag", "colors": ["image"], "tiles": "mask"})";

TEST_F(PassFiles, StepsMayDrawTiles) {
  EXPECT_EQ(reported(tiledPass(R"("format": "r8", "optional": true)", kTiledStep)), "");
  const PassDeclaration* d = registry_.find("blur");
  ASSERT_NE(d, nullptr);
  EXPECT_EQ(d->steps[0].tileMask, "mask");
  EXPECT_TRUE(any(d->findPort("mask")->members[0].usage, Usage::StorageRead)) << "follows from the step";
}

TEST_F(PassFiles, TilesAreReportedWhereTheyAreWrong) {
  const std::string where = "blur.pass.json:3:2: error: pass type `blur`: step `a`: ";
  expectReport(
      tiledPass(R"("format": "r8")", R"({"shader": "a.frag", "colors": ["image"], "tiles": "mark"})"),
      where + "no port `mark`; did you mean `mask`?");
  expectReport(
      tiledPass(R"("format": "r8")", R"({"shader": "a.frag", "colors": ["image"], "tiles": "image"})"),
      where + "`image` says which tiles to draw, so the step cannot write it");
  expectReport(tiledPass(R"("format": "r8")", R"({"shader": "a.comp", "over": "image", "tiles": "mask"})"),
               where + "only a fragment shader that writes images draws tiles");
  for (const char* wrong : {R"("format": "r32f")", R"("format": "r8", "layers": 2)", R"("optional": true)"})
    expectReport(tiledPass(wrong, kTiledStep),
                 where + "`mask` says which tiles to draw, so it has to be a flat image of the format r8");
  expectReport(tiledPass(R"("element": "uint")", kTiledStep), where + "`mask` is a buffer, not an image");
  expectReport(tiledPass(R"("format": "r8", "usage": ["sampled"])", kTiledStep),
               where + "port `mask` does not declare the usage StorageRead");
  expectReport(tiledPass(R"("format": "r8")", R"({"shader": "a.frag", "colors": ["image"], "tiles": 16})"),
               "blur.pass.json:3:53: error: `tiles`: expected a text, found the number 16");
}

TEST_F(PassFiles, MayLieInFoldersOfTheirOwn) {
  write("blur/blur.pass.json", kBlur);
  EXPECT_EQ(added(), "");
  EXPECT_EQ(registry_.find("blur")->steps[0].shader, (folder_ / "blur" / "rows.comp").string());
  EXPECT_EQ(added(), "") << "a folder may be named again";
}

TEST_F(PassFiles, OfOneNameAreRefused) {
  write("blur/blur.pass.json", kBlur);
  write("blur.pass.json", kBlur);
  EXPECT_NE(added().find("declare one pass type"), std::string::npos);
}

TEST_F(PassFiles, OfAKnownNameAreRefused) {
  registry_.add(PassDeclaration("blur", "Another"), nullptr);
  expectReport(kBlur, "blur.pass.json:1:1: error: there already is a pass type `blur`");
}

TEST_F(PassFiles, AreReportedWhereTheyAreWrong) {
  expectReport(R"({"doc": "x", "step": [], "steps": [{"shader": "a.comp", "over": "image"}],
                   "outputs": {"image": {"doc": "x", "format": "rgba8"}}})",
               "blur.pass.json:1:14: error: unknown key `step`");
  expectReport("{\n \"doc\": 7, \"steps\": [{\"shader\": \"a.comp\", \"groups\": [1]}]}",
               "blur.pass.json:2:9: error:");
  expectReport("{\"doc\": \"x\",\n \"steps\": []}",
               "blur.pass.json:2:11: error: a pass needs at least one step");
  expectReport(R"({"doc": "x"})", "steps");
  expectReport("{\"doc\": \"x\", \"steps\": [\n {\"over\": \"image\"}]}",
               "blur.pass.json:2:2: error: a step needs a `shader`, `fill`, `clear` or `copy`");
  expectReport("{\"doc\": \"x\", \"steps\": [\n {\"shader\": \"a.comp\"}]}",
               "blur.pass.json:2:2: error: a compute step needs a size");
  expectReport(
      "{\"doc\": \"x\", \"steps\": [\n {\"shader\": \"a.glsl\", \"groups\": [1]}]}",
      "blur.pass.json:2:13: error: the shader of a step without `colors` ends in `.comp`, not `a.glsl`");
  expectReport("{\"doc\": \"x\", \"steps\": [\n {\"shader\": \"a.comp\", \"groups\": [\"1 +\"]}]}",
               "blur.pass.json:2:38: error: `1 +`: the expression ends where a value is expected");
  expectReport(
      "{\"doc\": \"x\", \"outputs\": {\n \"image\": {\"doc\": \"x\", \"format\": \"rgba8x\"}}, "
      "\"steps\": [{\"shader\": \"a.comp\", \"over\": \"image\"}]}",
      "no texel format: the text \"rgba8x\"");
  expectReport(
      "{\"doc\": \"x\", \"outputs\": {\n \"image\": {\"doc\": \"x\", \"format\": \"rgba8\", \"light\": "
      "true}}, "
      "\"steps\": [{\"shader\": \"a.comp\", \"over\": \"image\"}]}",
      "port `image`: light needs a format of 16- or 32-bit floats");
  expectReport("{\"doc\": \"x\", \"steps\": [\n {\"shader\": \"a.comp\", \"over\": \"image\"}]}",
               "blur.pass.json:2:2: error: pass type `blur`: step `a`: no port `image`");
  expectReport(
      "{\"doc\": \"x\", \"params\": {\n \"p\": {\"doc\": \"x\", \"default\": 3, \"max\": 2}}, "
      "\"steps\": [{\"shader\": \"a.comp\", \"groups\": [1]}]}",
      "blur.pass.json:2:2: error: pass type `blur`: parameter `p`: the default 3 is outside");
  expectReport("{\"doc\": \"x\", \"steps\": [\n {\"shader\": \"a.comp\", \"groups\": [\"radius\"]}]}",
               "`radius` is over no whole-number parameter, choice or flag");
  expectReport("{\"doc\": \"x\",", "blur.pass.json:1:");
  expectReport(R"({"doc": "x", "steps": [{"shader": ["a.comp"], "groups": [1]}]})",
               "`shader`: expected a text");
  expectReport(R"({"doc": "x", "steps": [{"shader": "", "groups": [1]}]})", "ends in `.comp`, not ``");
}

TEST_F(PassFiles, ReportAllMistakesOfAllFilesAtOnce) {
  write("a.pass.json", R"({"doc": "x", "steps": []})");
  write("b.pass.json", R"({"steps": [{"shader": "a.comp"}], "colour": 1})");
  const std::string report = added();
  for (const char* part : {"a.pass.json:1:", "a compute step needs a size", "unknown key `colour`"})
    EXPECT_NE(report.find(part), std::string::npos) << report;
}

TEST_F(PassFiles, AShaderThatDoesNotCompileIsReportedInItsLine) {
  write("blur.comp", "layout(local_size_x = 8) in;\nvoid main() { nothing(); }\n");
  ASSERT_EQ(reported(R"({"doc": "x", "outputs": {"image": {"doc": "x", "format": "rgba8"}},
                         "steps": [{"shader": "blur.comp", "over": "image"}]})"),
            "");
  Diagnostics messages;
  const auto graph =
      bindText(R"({"passes": {"b": {"type": "blur"}}, "outputs": {"image": "b"}})", registry_, messages);
  gpu::ShaderCompiler compiler{fs::path()};
  CompileOptions options;
  options.shaders = [&](const std::string& file, const gpu::Defines& d) { return compiler.compile(file, d); };
  try {
    compile(graph, options);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(error.what()).find("blur.comp:2: error:"), std::string::npos) << error.what();
  }
}

TEST_F(PassFiles, AMissingFolderIsNamed) {
  try {
    registry_.addFolder(folder_ / "nothing");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("there is no folder of passes"), std::string::npos);
  }
}

TEST_F(PassFiles, HaveASchema) {
  const std::string schema = passFileSchema();
  for (const char* key : {"\"steps\"", "\"inputs\"", "\"shader\"", "\"together\"", "\"keep\"", "\"tiles\""})
    EXPECT_NE(schema.find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace fovea::graph::test
