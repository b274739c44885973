#include "framework/graph/pass/guard.h"

#include <cxxabi.h>
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <typeinfo>
#include <vector>

#include "fovea/error.h"
#include "framework/base/threads.h"

namespace fovea::graph {
namespace {

std::string nameOf(const PassOrigin& origin) {
  return origin.instance.empty() ? fmt::format("pass class `{}`", origin.type)
                                 : fmt::format("pass `{}` ({})", origin.instance, origin.type);
}

std::string describe(const PassOrigin& origin) {
  std::string text = nameOf(origin);
  if (!origin.plugin.empty()) text += fmt::format(" from plug-in {}", origin.plugin);
  return text;
}

// The type of the exception that is being handled.
std::string exceptionType() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  if (!type) return "?";
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(type->name(), nullptr, nullptr, nullptr), std::free);
  return name ? name.get() : type->name();
}

}  // namespace

void rethrowWithOrigin(const PassOrigin& origin, std::string_view function) {
  const char* remedy =
      origin.plugin.empty()
          ? "this is a mistake in the code of the pass, not in your input"
          : "this is a mistake in the code of the plug-in, not in fovea or in your input: tell "
            "the author of the plug-in";
  try {
    throw;
  } catch (const Error& e) {
    std::vector<Diagnostic> messages = e.diagnostics();
    const std::string name = nameOf(origin);
    for (Diagnostic& d : messages)
      if (!d.message.starts_with(name)) d.message = name + ": " + d.message;
    if (!origin.plugin.empty())
      messages.push_back({Severity::Note,
                          {},
                          {},
                          fmt::format("{} of plug-in {} reports this", function, origin.plugin),
                          {}});
    throw Error(e.code(), std::move(messages));
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::OutOfMemory,
                fmt::format("the computer's memory is exhausted, in {} of {}", function, describe(origin)),
                "render a smaller --size, or a smaller scene");
  } catch (const std::system_error& e) {
    if (isNoThread(e)) throw noThread(e);
    throw Error(ExitCode::Internal,
                fmt::format("{} threw {} in {}: {}", describe(origin), exceptionType(), function, e.what()),
                remedy);
  } catch (const std::exception& e) {
    throw Error(ExitCode::Internal,
                fmt::format("{} threw {} in {}: {}", describe(origin), exceptionType(), function, e.what()),
                remedy);
  } catch (...) {
    throw Error(
        ExitCode::Internal,
        fmt::format("{} threw an exception of type {} in {}", describe(origin), exceptionType(), function),
        remedy);
  }
}

}  // namespace fovea::graph
