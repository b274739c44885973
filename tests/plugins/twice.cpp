// The same pass type twice.
#include <fovea/pass.h>

namespace {

using namespace fovea::graph;

class First : public Pass {
 public:
  static PassDeclaration declaration() { return PassDeclaration("sound", "Does nothing."); }
};
class Second : public First {};
FOVEA_PASS(First);
FOVEA_PASS(Second);

}  // namespace
