#include "fovea/passes.h"
#include "framework/graph/pass/registry.h"

namespace fovea::passes {

// FOVEA_PASS has registered them when the library was loaded, where no exception can be caught.
void registerAll() { graph::Registry::throwIfRegistrationsFailed(); }

}  // namespace fovea::passes
