// The commands `fovea new graph` and `fovea new pass`: files to start from, which run as they are.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "framework/base/json.h"
#include "framework/base/paths.h"
#include "framework/base/text_file.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/pass/registry.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

namespace fs = std::filesystem;

// ---- The files ---------------------------------------------------------------------------------------

constexpr const char* kGraph = R"({{
  "version": {version},
  "description": "{name}: {base} with changes of its own",
  "extends": "{base}.json"
}}
)";

constexpr const char* kPass = R"({{
  "doc": "Darkens the picture towards its borders",
  "inputs": {{ "picture": "the picture to darken" }},
  "outputs": {{ "image": {{ "doc": "the darker picture", "format": "rgba8" }} }},
  "params": {{ "strength": {{ "doc": "0 changes nothing, 1 makes the corners black", "default": 0.5, "min": 0, "max": 1 }} }},
  "steps": [{{ "shader": "{shader}.frag", "colors": ["image"] }}]
}}
)";

constexpr const char* kShader = R"(uniform texture2D picture;
layout(push_constant) uniform Constants {{ float strength; }};
layout(location = 0) out vec4 image;
void main() {{
  vec2 fromMiddle = 2.0 * gl_FragCoord.xy / vec2(textureSize(picture, 0)) - 1.0;
  vec4 color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  image = vec4(color.rgb * (1.0 - 0.5 * strength * dot(fromMiddle, fromMiddle)), color.a);
}}
)";

constexpr const char* kPassGraph = R"({{
  "version": {version},
  "description": "Direct light and the pass {name} after it",
  "extends": "direct.json",
  "passes": {{ "{name}": {{ "type": "{name}", "inputs": {{ "picture": "tonemap" }} }} }},
  "outputs": {{ "image": "{name}" }}
}}
)";

constexpr const char* kPassTest = R"sh(#!/bin/sh
# Tests the pass: with strength 0 the picture stays as it is, with strength 1 it changes. FOVEA names the program.
set -eu
cd "$(dirname "$0")"
fovea=${{FOVEA:-fovea}}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
render() {{
  "$fovea" render "$@" --scene cornellbox --size 64x64 --quiet
}}
render direct -o "$out/before.png"
render {name}.json --set {name}.strength=0 -o "$out/same.png"
render {name}.json --set {name}.strength=1 -o "$out/other.png"
"$fovea" diff "$out/before.png" "$out/same.png" --check
if "$fovea" diff "$out/before.png" "$out/other.png" --check; then
  echo "the pass changes nothing"
  exit 1
fi
echo "passed"
)sh";

// ---- Commands ----------------------------------------------------------------------------------------

struct NewOptions {
  std::string name, base = "ours";
};

void refuseExisting(const fs::path& path) {
  std::error_code ec;
  if (fs::exists(path, ec))
    throw Error(ExitCode::CannotWrite, fmt::format("{} is there already", path.string()),
                "choose another name, or remove it");
}

ExitCode newGraph(const NewOptions& options) {
  std::string base = options.base;
  if (base.ends_with(".json")) base.resize(base.size() - 5);
  const std::vector<fs::path> folders = dataFolders("graphs");
  fs::path file = options.name;
  if (file.extension() != ".json") file += ".json";
  const bool beside = !graph::findGraphFile(base, file, folders).empty();
  if (!beside) graph::findGraph(base, folders);  // says what is near
  if (!beside)
    throw Error(ExitCode::BadInput,
                fmt::format("`{}` is neither beside {} nor a stock graph", base, file.string()),
                "put the new graph into the folder of the one that it extends");
  refuseExisting(file);
  writeText(file, fmt::format(kGraph, fmt::arg("version", graph::kGraphVersion),
                              fmt::arg("name", file.stem().string()), fmt::arg("base", base)));
  fmt::print("wrote {}\n  fovea describe {}    shows what can be set\n", file.string(), file.string());
  return ExitCode::Ok;
}

ExitCode newPass(const NewOptions& options) {
  const fs::path folder = options.name;
  const std::string name = folder.filename().string();
  const bool good =
      !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
      });
  if (!good)
    throw Error(ExitCode::Usage, fmt::format("`{}` is no name for a pass type", name),
                "lower-case letters, digits and -, beginning with a letter");
  if (graph::Registry::global().find(name))
    throw Error(ExitCode::BadInput, fmt::format("there is a pass type `{}` already", name),
                fmt::format("`fovea passes {}` shows it; choose another name", name));
  refuseExisting(folder);
  std::error_code ec;
  if (!fs::create_directories(folder / "passes", ec))
    throw Error(ExitCode::CannotWrite, fmt::format("the folder {} cannot be made", folder.string()),
                ec.message());
  std::string shader = name;
  std::ranges::replace(shader, '-', '_');
  const auto write = [&](const fs::path& file, const char* text) {
    writeText(folder / file, fmt::format(fmt::runtime(text), fmt::arg("version", graph::kGraphVersion),
                                         fmt::arg("name", name), fmt::arg("shader", shader)));
    fmt::print("wrote {}\n", (folder / file).string());
  };
  write(fs::path("passes") / (name + ".pass.json"), kPass);
  write(fs::path("passes") / (shader + ".frag"), kShader);
  write(name + ".json", kPassGraph);
  write("test.sh", kPassTest);
  fs::permissions(folder / "test.sh", fs::perms::owner_exec, fs::perm_options::add, ec);
  fmt::print("  fovea render {}/{}.json --scene cornellbox -o {}.png    uses the pass\n", folder.string(),
             name, name);
  fmt::print("  {}/test.sh    tests it\n", folder.string());
  return ExitCode::Ok;
}

}  // namespace

void addNew(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("new", "Make a graph or a pass to start from")->require_subcommand(1);
  auto options = std::make_shared<NewOptions>();
  CLI::App* graph = command->add_subcommand("graph", "A graph file that extends another graph");
  graph->add_option("NAME", options->name, "File to write, with or without .json")->required()->type_name("");
  graph->add_option("--extends", options->base, "Graph to extend; default ours")->type_name("GRAPH");
  graph->callback([options, &action] { action = [options] { return newGraph(*options); }; });
  CLI::App* pass =
      command->add_subcommand("pass", "A folder with a pass, a graph that uses it, and its test");
  pass->add_option("NAME", options->name, "Name of the pass type and of the folder")
      ->required()
      ->type_name("");
  pass->callback([options, &action] { action = [options] { return newPass(*options); }; });
}

}  // namespace fovea::cli
