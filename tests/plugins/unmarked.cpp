// A registration without the mark of a version in the file.
#include <fovea/pass.h>

namespace {

using namespace fovea::graph;

class Sound : public Pass {
 public:
  static PassDeclaration declaration() { return PassDeclaration("sound", "Does nothing."); }
};
const Registration kRegistration(fovea::graph::passAbi(), "Sound", &Sound::declaration,
                                 []() -> std::unique_ptr<Pass> { return std::make_unique<Sound>(); });

}  // namespace
