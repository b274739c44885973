// The declaration of the only pass throws something that is no std::exception.
#include <fovea/pass.h>

namespace {

using namespace fovea::graph;

class Thrower : public Pass {
 public:
  static PassDeclaration declaration() { throw "the moon is too far away"; }
};
FOVEA_PASS(Thrower);

}  // namespace
