// Implements check() of the facade fovea/document.h.
#include "framework/base/paths.h"
#include "framework/gpu/shader/disk_cache.h"
#include "framework/gpu/shader/shader.h"
#include "framework/graph/document/document.h"
#include "framework/graph/report/report.h"
#include "framework/session/graph_run.h"

namespace fovea::graph {

std::string check(const Document& document, PlanForm form, const CheckOptions& options,
                  Diagnostics& messages) {
  LoadOptions load;
  for (const std::string& text : options.set) load.overrides.push_back(parseOverride(text));
  load.searchPaths = dataFolders("graphs");
  Registry::global().addFoldersFromEnvironment();
  Registry::global().addFolderBeside(document.file());
  const Description description = resolve(document, load, messages);
  const auto bound = std::make_shared<const BoundGraph>(
      bind(description, session::sceneEnvironment(nullptr, {}, {}, options.size), messages));
  gpu::ShaderCompiler compiler(gpu::defaultCacheDirectory());
  addShaderFolders(compiler, Registry::global());
  CompileOptions compileOptions;
  compileOptions.shaders = [&](const std::string& file, const gpu::Defines& defines) {
    return compiler.compile(file, defines);
  };
  const Plan plan = compile(bound, compileOptions);
  warnAboutPlan(plan, messages);
  return writePlan(plan, form);
}

}  // namespace fovea::graph
