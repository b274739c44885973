// Tests the shader compiler without a device: located errors, includes and the cache.
#include "framework/gpu/shader/shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "fovea/error.h"

namespace fovea {
namespace {

using gpu::ShaderCompiler;
using testing::HasSubstr;
namespace fs = std::filesystem;

class ShaderTest : public testing::Test {
 protected:
  ShaderTest() {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("fovea-" + std::string(info->name()) + "-" + std::to_string(getpid()));
    fs::create_directories(folder_ / "shaders");
  }
  ~ShaderTest() override {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  void file(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / "shaders" / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  fs::path cache() const { return folder_ / "cache"; }
  std::vector<fs::path> cacheFiles() const {
    std::vector<fs::path> list;
    for (const auto& entry : fs::directory_iterator(cache())) list.push_back(entry.path());
    return list;
  }
  std::unique_ptr<ShaderCompiler> compiler() const {
    auto c = std::make_unique<ShaderCompiler>(cache());
    c->addSearchPath(folder_ / "shaders");
    return c;
  }
  // The errors of a compilation that must fail.
  std::vector<Diagnostic> errors(const std::string& name, const gpu::Defines& defines = {}) const {
    try {
      compiler()->compile(name, defines);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      return e.diagnostics();
    }
    ADD_FAILURE() << name << " compiled";
    return {};
  }

  fs::path folder_;
};

constexpr const char* kVersion = "#version 460\n";
constexpr const char* kBody = R"(
layout(local_size_x = 8) in;
layout(std430) buffer Data { uint data[]; };
void main() { data[gl_GlobalInvocationID.x] = VALUE; }
)";
const std::string kGood = std::string(kVersion) + kBody;

TEST_F(ShaderTest, ErrorsCarryFileAndLine) {
  file("a/bad.comp",
       "#version 460\nlayout(local_size_x = 8) in;\nvoid main() {\n  float x = missing;\n  float y = "
       "nor_this;\n}\n");
  const std::vector<Diagnostic> list = errors("a/bad.comp");
  ASSERT_EQ(list.size(), 2u);  // both mistakes, and no summary line
  EXPECT_THAT(list[0].where.file, testing::EndsWith("shaders/a/bad.comp"));
  EXPECT_EQ(list[0].where.line, 4);
  EXPECT_THAT(list[0].message, HasSubstr("missing"));
  EXPECT_EQ(list[1].where.line, 5);
  EXPECT_THAT(list[1].message, HasSubstr("nor_this"));
  EXPECT_THAT(list[0].format(), HasSubstr("bad.comp:4: error: "));
}

TEST_F(ShaderTest, MessagesOfSeveralLinesStayTogether) {
  file("a.vert", "#version 460\nvoid main() { gl_Layer = 1; gl_Position = vec4(0); }\n");
  const std::vector<Diagnostic> list = errors("a.vert");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].where.line, 2);
  EXPECT_THAT(list[0].message, HasSubstr("GL_ARB_shader_viewport_layer_array"));
}

TEST_F(ShaderTest, ErrorsInsideIncludesAreLocatedThere) {
  file("common/deep.glsl", "\n\nfloat deep() { return wrong; }\n");
  file("common/outer.glsl", "#include \"deep.glsl\"\n");  // beside the including file
  file("a/main.comp",
       "#version 460\n#include \"common/outer.glsl\"\nlayout(local_size_x = 8) in;\nvoid main() { deep(); "
       "oops; }\n");
  const std::vector<Diagnostic> list = errors("a/main.comp");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_THAT(list[0].where.file, testing::EndsWith("common/deep.glsl"));
  EXPECT_EQ(list[0].where.line, 3);
  EXPECT_THAT(list[1].where.file, testing::EndsWith("a/main.comp"));
  EXPECT_EQ(list[1].where.line, 4);  // back in the including file
}

TEST_F(ShaderTest, MissingIncludeNamesFileAndLine) {
  file("main.comp", "#version 460\n\n#include \"nowhere.glsl\"\nvoid main() {}\n");
  const std::vector<Diagnostic> list = errors("main.comp");
  ASSERT_GE(list.size(), 1u);
  EXPECT_EQ(list[0].where.line, 3);
  EXPECT_THAT(list[0].message, HasSubstr("nowhere.glsl"));
  EXPECT_THAT(list[0].message, HasSubstr("not found"));
}

TEST_F(ShaderTest, MissingIncludeInDeadCodeIsNoError) {
  file("main.comp",
       "#version 460\n#ifdef NEVER\n#include \"nowhere.glsl\"\n#endif\n// #include \"neither\"\nvoid main() "
       "{}\n");
  EXPECT_NO_THROW(compiler()->compile("main.comp"));
}

TEST_F(ShaderTest, EndlessIncludeIsAnError) {
  file("loop.glsl", "#include \"loop.glsl\"\n");
  file("main.comp", "#version 460\n#include \"loop.glsl\"\nvoid main() {}\n");
  EXPECT_THAT(errors("main.comp").at(0).message, HasSubstr("#pragma once"));
}

TEST_F(ShaderTest, PragmaOnce) {
  file("once.glsl", "#pragma once\nfloat f() { return 1.0; }\n");
  file("second.glsl", "#include \"once.glsl\"\n");
  file("main.comp",
       "#version 460\n#include \"once.glsl\"\n#include \"second.glsl\"\n#include \"once.glsl\"\nvoid main() "
       "{ f(); }\n");
  EXPECT_NO_THROW(compiler()->compile("main.comp"));
}

TEST_F(ShaderTest, PragmaOnceCausesNoMessageAndMovesNoLine) {
  file("once.glsl", "// Comment\n # pragma once // here\nfloat f() { return wrong; }\n");
  file("main.comp", "#version 460\n#include \"once.glsl\"\nvoid main() { missing; }\n");
  const std::vector<Diagnostic> list = errors("main.comp");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_THAT(list[0].where.file, testing::EndsWith("once.glsl"));
  EXPECT_EQ(list[0].where.line, 3);
  EXPECT_THAT(list[1].where.file, testing::EndsWith("main.comp"));
  EXPECT_EQ(list[1].where.line, 3);
}

TEST_F(ShaderTest, TheCacheTellsPragmaOnceFromABlankLine) {
  file("main.comp", "#version 460\n#include \"f.glsl\"\n#include \"f.glsl\"\nvoid main() { f(); }\n");
  file("f.glsl", "#pragma once\nfloat f() { return 1.0; }\n");
  EXPECT_NO_THROW(compiler()->compile("main.comp"));
  file("f.glsl", "            \nfloat f() { return 1.0; }\n");
  EXPECT_THAT(errors("main.comp").at(0).message, HasSubstr("f"));
}

TEST_F(ShaderTest, OwnFolderComesBeforeSearchPaths) {
  file("value.glsl", "#define VALUE wrong\n");
  file("a/value.glsl", "#define VALUE 1u\n");
  file("a/main.comp", std::string("#version 460\n#include \"value.glsl\"\n") + kBody);
  EXPECT_NO_THROW(compiler()->compile("a/main.comp"));
}

TEST_F(ShaderTest, MissingFileAndUnknownStage) {
  try {
    compiler()->compile("gone.comp");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_THAT(e.what(), HasSubstr("`gone.comp` not found"));
    EXPECT_THAT(e.what(), HasSubstr((folder_ / "shaders").string()));
  }
  file("stage.glsl", kGood);
  EXPECT_THAT(errors("stage.glsl").at(0).message, HasSubstr("stage"));
}

TEST_F(ShaderTest, DefinesReachTheShader) {
  file("main.comp", kGood);
  EXPECT_THAT(errors("main.comp").at(0).message, HasSubstr("VALUE"));
  auto c = compiler();
  const auto one = c->compile("main.comp", {{"VALUE", "1u"}});
  const auto two = c->compile("main.comp", {{"VALUE", "2u"}});
  EXPECT_NE(one->spirv, two->spirv);
  EXPECT_NE(one->hash, two->hash);
  EXPECT_EQ(one, c->compile("main.comp", {{"VALUE", "1u"}}));
  EXPECT_EQ(c->statistics().compiled, 2u);
  EXPECT_EQ(c->statistics().fromMemory, 1u);
}

TEST_F(ShaderTest, TextWithoutAFile) {
  ShaderCompiler c({});  // no disk cache, no search path
  EXPECT_NO_THROW(c.compileSource("inline.comp", kGood, {{"VALUE", "7u"}}));
  try {
    c.compileSource("inline: one.comp", "#version 460\nvoid main() { x; }\n");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().at(0).where.file, "inline: one.comp");
    EXPECT_EQ(e.diagnostics().at(0).where.line, 2);
  }
}

TEST_F(ShaderTest, SecondProcessFindsTheCache) {
  file("main.comp", kGood);
  const auto first = compiler();
  const auto a = first->compile("main.comp", {{"VALUE", "1u"}});
  EXPECT_EQ(first->statistics().compiled, 1u);
  const auto second = compiler();
  const auto b = second->compile("main.comp", {{"VALUE", "1u"}});
  EXPECT_EQ(second->statistics().compiled, 0u);
  EXPECT_EQ(second->statistics().fromDisk, 1u);
  EXPECT_EQ(a->spirv, b->spirv);
  EXPECT_EQ(a->hash, b->hash);
  EXPECT_EQ(a->reflection.bindings.size(), b->reflection.bindings.size());
  EXPECT_TRUE(b->reflection.bindings.at(0).automatic);
}

TEST_F(ShaderTest, ChangedIncludeIsNeverServedFromTheCache) {
  file("value.glsl", "#define VALUE 1u\n");
  file("main.comp", std::string("#version 460\n#include \"value.glsl\"\n") + kBody);
  const auto before = compiler()->compile("main.comp");
  file("value.glsl", "#define VALUE 2u\n");
  const auto c = compiler();
  EXPECT_NE(c->compile("main.comp")->spirv, before->spirv);
  EXPECT_EQ(c->statistics().compiled, 1u);
}

// A file that appears beside the shader takes precedence over one further down the search path.
TEST_F(ShaderTest, ShadowingIncludeIsNeverServedFromTheCache) {
  file("value.glsl", "#define VALUE 1u\n");
  file("a/main.comp", std::string("#version 460\n#include \"value.glsl\"\n") + kBody);
  const auto before = compiler()->compile("a/main.comp");
  file("a/value.glsl", "#define VALUE 2u\n");
  const auto c = compiler();
  EXPECT_NE(c->compile("a/main.comp")->spirv, before->spirv);
  EXPECT_EQ(c->statistics().compiled, 1u);
}

TEST_F(ShaderTest, DamagedCacheFilesAreReplaced) {
  file("main.comp", kGood);
  const auto good = compiler()->compile("main.comp", {{"VALUE", "1u"}});
  ASSERT_EQ(cacheFiles().size(), 1u);  // and no temporary is left
  const fs::path path = cacheFiles()[0];
  const auto size = fs::file_size(path);

  const auto damages = {
      std::function<void()>([&] { fs::resize_file(path, size / 2); }),
      std::function<void()>([&] { fs::resize_file(path, 0); }),
      std::function<void()>([&] { fs::resize_file(path, size + 4); }),
      std::function<void()>([&] {
        std::fstream f(path, std::ios::in | std::ios::out | std::ios::binary);
        f.seekp(std::streamoff(size - 6));
        f.put('\x55');
      }),
      std::function<void()>([&] { std::ofstream(path) << "not a cache file at all, just some text"; }),
  };
  for (const auto& damage : damages) {
    damage();
    const auto c = compiler();
    EXPECT_EQ(c->compile("main.comp", {{"VALUE", "1u"}})->spirv, good->spirv);
    EXPECT_EQ(c->statistics().compiled, 1u);
    EXPECT_EQ(fs::file_size(path), size);  // complete again
  }
}

TEST_F(ShaderTest, UnwritableCacheIsNoError) {
  std::ofstream(cache()) << "a file where the folder should be";
  file("main.comp", kGood);
  EXPECT_NO_THROW(compiler()->compile("main.comp", {{"VALUE", "1u"}}));
}

TEST_F(ShaderTest, ResourcesOutsideSetZeroNeedABinding) {
  file("main.comp",
       "#version 460\nlayout(set = 1) uniform texture2D t;\nvoid main() { texelFetch(t, ivec2(0), 0); }\n");
  EXPECT_THAT(errors("main.comp").at(0).message, HasSubstr("`t`"));
}

}  // namespace
}  // namespace fovea
