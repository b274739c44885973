// A sound pass between two whose declarations fail: nothing of this plug-in may be registered.
#include <fovea/pass.h>

#include <stdexcept>

namespace {

using namespace fovea::graph;

class Contradiction : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("contradiction", "Has a default that is out of range.");
    d.parameter("count", integer(5, 6, 9), "a number");
    return d;
  }
};

class Sound : public Pass {
 public:
  static PassDeclaration declaration() { return PassDeclaration("sound", "Does nothing."); }
};

class Thrower : public Pass {
 public:
  static PassDeclaration declaration() { throw std::out_of_range("the moon is too far away"); }
};

FOVEA_PASS(Contradiction);
FOVEA_PASS(Sound);
FOVEA_PASS(Thrower);

}  // namespace
