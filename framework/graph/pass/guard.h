// Turns exceptions that leave a pass into errors that name the pass.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace fovea::graph {

struct PassOrigin {
  std::string_view instance;  // name in the graph; empty before there is one
  std::string_view type;      // or the name of the C++ class as long as the type is not known
  std::string_view plugin;    // file of the plug-in; empty for a pass that is linked in
};

// To be called while an exception that left `function` ("prepare()") of the pass is being handled. An Error keeps its
// code. Its messages begin with the pass, by name and type, so that passes need not say who they are; from a plug-in, it
// gains a note. std::bad_alloc becomes Error(OutOfMemory) and anything else Error(Internal).
[[noreturn]] void rethrowWithOrigin(const PassOrigin& origin, std::string_view function);

template <class Body>
decltype(auto) guarded(const PassOrigin& origin, std::string_view function, Body&& body) {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    rethrowWithOrigin(origin, function);
  }
}

}  // namespace fovea::graph
