// A pass that is registered with the mark of another version, as if it came from a library that the plug-in is linked
// to. The framework must not even ask for its declaration.
#include <fovea/pass.h>

#include <cstdlib>

namespace {

using namespace fovea::graph;

class Sound : public Pass {
 public:
  static PassDeclaration declaration() { return PassDeclaration("sound", "Does nothing."); }
};
FOVEA_PASS(Sound);

constexpr fovea::Abi kOther{"fovea 0.0.7 0123456789abcdef"};
const Registration kRegistration(
    kOther, nullptr, []() -> PassDeclaration { std::abort(); },
    []() -> std::unique_ptr<Pass> { std::abort(); });

}  // namespace
