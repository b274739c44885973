// Tests the commands that move data without a kernel: what they do, and the messages for passes that may not use them.
#include <gtest/gtest.h>

#include "fovea/error.h"
#include "framework/graph/pass/registry.h"
#include "tests/support/graph_runner.h"

namespace fovea::graph {
namespace {

using namespace test;  // NOLINT: helpers

// A pass that copies, with a declaration that may be wrong.
class CopyImage : public Pass {
 public:
  static PassDeclaration declare(const char* type, Usage from, Usage to) {
    PassDeclaration d(type, "Copies an image.");
    d.input("from", image2D(kFormat), from, "what to copy");
    d.output("to", image2D(kFormat, parameter("width"), parameter("height")), to, "the copy");
    d.parameter("width", integer(kSide, 1, 1 << 10), "of the copy");
    d.parameter("height", integer(kSide, 1, 1 << 10), "of the copy");
    return d;
  }
  static PassDeclaration declaration() {
    return declare("test-copy", Usage::TransferRead, Usage::TransferWrite);
  }
  void record(RecordContext& context) override { context.copy("from", "to"); }
};
FOVEA_PASS(CopyImage);

struct CopyUnread : CopyImage {
  static PassDeclaration declaration() {
    return declare("test-copy-unread", Usage::Sampled, Usage::TransferWrite);
  }
};
FOVEA_PASS(CopyUnread);

struct CopyUnwritten : CopyImage {
  static PassDeclaration declaration() {
    return declare("test-copy-unwritten", Usage::TransferRead, Usage::StorageWrite);
  }
};
FOVEA_PASS(CopyUnwritten);

// Copies the output of test-fill into an image that differs from it in something other than its width or height.
class CopyUnlike : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-copy-unlike", "Copies an image into another kind of image.");
    d.input("from", image2D(kFormat), Usage::TransferRead, "what to copy");
    d.output("layers", image2DArray(kFormat, kSide, kSide, 2), Usage::TransferWrite, "of more layers");
    d.output("texels", image2D(VK_FORMAT_R32G32_UINT, kSide, kSide), Usage::TransferWrite, "of wider texels");
    d.output("mips", image2D(kFormat, kSide, kSide, 2), Usage::TransferWrite, "of more mips");
    d.parameter("into", choice("layers", {"layers", "texels", "mips"}), "where to");
    return d;
  }
  void record(RecordContext& context) override { context.copy("from", context.parameters().text("into")); }
};
FOVEA_PASS(CopyUnlike);

// Takes an image for a buffer, or a buffer for an image.
class MistakeKinds : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-mistake-kinds", "Takes one kind of resource for the other.");
    d.input("from", image2D(kFormat), Usage::TransferRead, "an image");
    d.output("to", buffer("uint", 4, 16), Usage::TransferWrite, "a buffer");
    d.parameter("as", choice("fill", {"fill", "clear", "copy", "image", "buffer"}), "what with");
    return d;
  }
  void record(RecordContext& context) override {
    const std::string& as = context.parameters().text("as");
    if (as == "fill") context.fill("from", 0);
    if (as == "clear") context.clear("to", {});
    if (as == "copy") context.copy("from", "to");
    if (as == "image") context.image("to");
    if (as == "buffer") context.buffer("from");
  }
};
FOVEA_PASS(MistakeKinds);

std::string copyGraph(const std::string& type, const std::string& params = "",
                      const std::string& port = "to") {
  return R"({"passes": {"fill": {"type": "test-fill", "params": {"key": 7}},
    "copier": {"type": ")" +
         type + R"(", "inputs": {"from": "fill"}, "params": {)" + params + R"(}}},
    "outputs": {"x": "copier.)" +
         port + R"("}})";
}

TEST(Transfers, CopiesWholeImages) {
  Runner runner(copyGraph("test-copy"));
  for (uint32_t i = 0; i < 3; ++i) expectAll(runner.frame(), "x", 7 + i);
}

// Each message names the pass, its ports and what is wrong.
TEST(Transfers, WrongOnesAreNamed) {
  constexpr ExitCode kPass = ExitCode::Internal, kGraph = ExitCode::BadInput;  // the pass at fault
  const struct {
    std::string graph;
    ExitCode code;
    std::vector<std::string> named;
  } cases[] = {
      {copyGraph("test-copy-unread"), kPass, {"`to`", "Usage::TransferRead on `from`"}},
      {copyGraph("test-copy-unwritten"), kPass, {"`from`", "Usage::TransferWrite on `to`"}},
      {copyGraph("test-copy", R"("width": 20)"), kGraph, {"`from`", "24x24", "`to`", "20x24"}},
      {copyGraph("test-copy", R"("height": 30)"), kGraph, {"`from`", "24x24", "`to`", "24x30"}},
      {copyGraph("test-copy-unlike", R"("into": "layers")", "layers"),
       kGraph,
       {"`from`", "`layers`", "2 layers"}},
      {copyGraph("test-copy-unlike", R"("into": "texels")", "texels"),
       kGraph,
       {"`from`", "r32ui", "`texels`", "rg32ui"}},
      {copyGraph("test-copy-unlike", R"("into": "mips")", "mips"), kGraph, {"`from`", "`mips`", "2 mips"}},
      {copyGraph("test-mistake-kinds", R"("as": "fill")"), kPass, {"takes `from` for a buffer"}},
      {copyGraph("test-mistake-kinds", R"("as": "clear")"), kPass, {"takes `to` for an image"}},
      {copyGraph("test-mistake-kinds", R"("as": "copy")"), kPass, {"takes `to` for an image"}},
      {copyGraph("test-mistake-kinds", R"("as": "image")"), kPass, {"takes `to` for an image"}},
      {copyGraph("test-mistake-kinds", R"("as": "buffer")"), kPass, {"takes `from` for a buffer"}},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.named.back());
    Runner runner(c.graph);
    try {
      runner.frame();
      ADD_FAILURE() << "no error";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), c.code);
      const std::string message = e.what();
      EXPECT_NE(message.find("pass `copier`"), std::string::npos) << message;
      for (const std::string& name : c.named) EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace fovea::graph
