#include "samples/fovea/view/resume.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fovea/error.h"

namespace fovea::view {
namespace {

constexpr const char* kVariable = "FOVEA_VIEW_RESUME";  // which other users cannot read, unlike arguments
constexpr const char* kProgram = "/proc/self/exe";
constexpr size_t kMostText = 4096;  // of what the other process says

std::vector<char*> pointersTo(std::vector<std::string>& arguments) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> ownArguments() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(stream, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

}  // namespace

std::string whyNotLoadable(const session::GraphOptions& options) {
  std::vector<std::string> arguments{"fovea", "check", options.graph};
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) arguments.insert(arguments.end(), {option, value});
  };
  add("--plugin", options.plugins);
  add("--passes", options.passes);
  add("--set", options.set);
  const std::vector<char*> pointers = pointersTo(arguments);
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "another process cannot be started";
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    execv(kProgram, pointers.data());
    _exit(127);
  }
  close(ends[1]);
  std::string text;
  std::array<char, 1024> bytes;
  for (ssize_t size; child > 0 && (size = read(ends[0], bytes.data(), bytes.size())) > 0;)
    if (text.size() < kMostText) text.append(bytes.data(), size_t(size));
  close(ends[0]);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return "another process cannot be started";
  if (WIFSIGNALED(status))
    return fmt::format("loading it ends the program ({})", strsignal(WTERMSIG(status)));
  return WEXITSTATUS(status) == 0 ? "" : text;
}

void startAnew(const Resume& resume) {
  const nlohmann::json json{
      {"token", resume.token},           {"port", resume.port},     {"graph", resume.graph},
      {"scene", resume.scene},           {"second", resume.second}, {"tev", resume.tev},
      {"accumulate", resume.accumulate}, {"set", resume.set},       {"width", resume.width},
      {"height", resume.height},         {"seed", resume.seed},     {"motion", resume.motion}};
  setenv(kVariable, json.dump().c_str(), 1);
  std::vector<std::string> arguments = ownArguments();
  execv(kProgram, pointersTo(arguments).data());
  throw Error(ExitCode::Internal,
              fmt::format("the program cannot start itself anew: {}", std::strerror(errno)));
}

std::optional<Resume> takeResume() {
  const char* text = std::getenv(kVariable);
  if (!text) return std::nullopt;
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  unsetenv(kVariable);
  try {
    return Resume{json.at("token"),  json.at("port"),   json.at("graph"),      json.at("scene"),
                  json.at("second"), json.at("tev"),    json.at("accumulate"), json.at("set"),
                  json.at("width"),  json.at("height"), json.at("seed"),       json.at("motion")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace fovea::view
