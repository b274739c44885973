#include "framework/graph/run/host_kernel.h"

#include <filesystem>
#include <map>
#include <utility>

namespace fovea::graph {
namespace {

using Key = std::pair<std::string, Defines>;

std::map<Key, HostKernel>& kernels() {
  static std::map<Key, HostKernel> all;
  return all;
}

}  // namespace

void addHostKernel(std::string shader, Defines defines, HostKernel kernel) {
  kernels().insert_or_assign(Key(std::move(shader), std::move(defines)), kernel);
}

HostKernel findHostKernel(const std::string& shader, const Defines& defines) {
  const std::filesystem::path path(shader);
  const std::string name = (path.parent_path().filename() / path.filename()).string();
  const auto found = kernels().find(Key(name, defines));
  return found == kernels().end() ? nullptr : found->second;
}

}  // namespace fovea::graph
