// The command `fovea scene export`: writes a scene for other programs.
#include <fmt/format.h>

#include <memory>

#include "fovea/scene.h"
#include "framework/base/files.h"
#include "framework/scene/export/gltf.h"
#include "framework/scene/export/mitsuba.h"
#include "framework/scene/load.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string scene, folder, format = "gltf", size = "512x512", materials = "diffuse";
  double time = 0;
  uint32_t frame = 0, samples = 64, depth = 4;
};

// An exporter makes many files, whose names are often those of the model's own.
void checkFolder(const fs::path& folder) {
  for (const fs::path& file : filesRead())
    for (const char* part : {"", "textures", "meshes"})
      if (sameFile(fs::absolute(file).parent_path(), folder / part))
        throw Error(ExitCode::Usage,
                    "the output folder `" + folder.string() + "` holds the file `" + file.string() +
                        "`, which is an input of this command and could be replaced",
                    "choose another folder");
}

ExitCode exportScene(const ExportOptions& o) {
  scene::MitsubaOptions mitsuba;
  mitsuba.size = parseSize(o.size);
  mitsuba.samples = o.samples;
  mitsuba.depth = o.depth;
  mitsuba.full = o.materials == "full";
  mitsuba.time = o.frame > 0 ? o.frame / 42.0 : o.time;  // `render` shows frame N at that time
  Diagnostics messages;
  const scene::Scene s = scene::load(o.scene, messages);
  checkFolder(o.folder);
  const fs::path file = o.format == "mitsuba" ? scene::exportMitsuba(s, o.folder, mitsuba, messages)
                                              : scene::exportGltf(s, o.folder, messages);
  printWarnings(messages);
  fmt::print("{}\n", file.string());
  return ExitCode::Ok;
}

}  // namespace

void addSceneExport(CLI::App& sceneCommand, Action& action) {
  CLI::App* command = sceneCommand.add_subcommand(
      "export", "Write a scene as glTF (with a scene file beside it) or for the renderer Mitsuba 3");
  auto o = std::make_shared<ExportOptions>();
  command->add_option("SCENE", o->scene, "A .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", o->folder, "Folder to write into; made where it is missing")
      ->required()
      ->type_name("DIR");
  command->add_option("--format", o->format, "gltf (default) or mitsuba")
      ->check(CLI::IsMember({"gltf", "mitsuba"}))
      ->type_name("FORMAT");
  auto* time = command->add_option("--time", o->time, "mitsuba: the moment to export, s; default 0")
                   ->check(numberBetween(0, 1e6))
                   ->type_name("T");
  command->add_option("--frame", o->frame, "mitsuba: the same as a frame of `fovea render`, 42 a second")
      ->transform(wholeNumberBetween(0, 1 << 30))
      ->excludes(time)
      ->type_name("N");
  command->add_option("--size", o->size, "mitsuba: size of the picture; default 512x512")->type_name("WxH");
  command->add_option("--spp", o->samples, "mitsuba: samples a pixel; default 64")
      ->transform(wholeNumberBetween(1, 1 << 24))
      ->type_name("N");
  command->add_option("--depth", o->depth, "mitsuba: longest path; 1 emission, 2 direct light; default 4")
      ->transform(wholeNumberBetween(1, 1000))
      ->type_name("N");
  command->add_option("--materials", o->materials, "mitsuba: diffuse (default) or full")
      ->check(CLI::IsMember({"diffuse", "full"}))
      ->type_name("KIND");
  addFollowLinksOption(*command);
  command->callback([o, &action] { action = [o] { return exportScene(*o); }; });
}

}  // namespace fovea::cli
