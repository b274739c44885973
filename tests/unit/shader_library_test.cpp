// Compiles the examples of shaders/README.md, so that what users copy works.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "fovea/error.h"
#include "framework/gpu/shader/shader.h"
#include "places.h"

namespace fovea {
namespace {

TEST(ShaderLibrary, ExamplesOfThePageCompile) {
  std::ifstream in(FOVEA_SOURCE_DIR "/shaders/README.md");
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  gpu::ShaderCompiler compiler("");
  compiler.addSearchPath(FOVEA_SOURCE_DIR "/shaders");
  const std::string fence = "```glsl\n";
  int examples = 0;
  for (size_t begin = page.find(fence); begin != std::string::npos; begin = page.find(fence, begin + 1)) {
    const size_t first = begin + fence.size();
    std::string text = page.substr(first, page.find("```", first) - first);
    if (text.find("#include") == std::string::npos) continue;  // a list of declarations
    if (text.find("void main()") == std::string::npos)
      text += "layout(local_size_x = 1) in;\nvoid main() {}\n";
    const std::string name = "example " + std::to_string(++examples) + " of the page.comp";
    try {
      compiler.compileSource(name, text);
    } catch (const Error& e) {
      for (const Diagnostic& d : e.diagnostics()) ADD_FAILURE() << d.format() << "\n" << text;
    }
  }
  EXPECT_GE(examples, 9);
}

}  // namespace
}  // namespace fovea
