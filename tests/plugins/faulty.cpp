// Passes that throw in each of their functions. The parameter `throws` says what.
#include <fovea/error.h>
#include <fovea/pass.h>

#include <new>
#include <stdexcept>

namespace {

using namespace fovea::graph;

PassDeclaration faulty(const char* type, PassKind kind = PassKind::Compute) {
  PassDeclaration d(type, "Throws an exception.", kind);
  d.output("image", image2D(VK_FORMAT_R8G8B8A8_UNORM),
           kind == PassKind::Host ? Usage::HostWrite : Usage::StorageWrite, "never written");
  d.parameter("throws", choice("standard", {"standard", "number", "memory", "input", "nothing"}),
              "the exception");
  return d;
}

void fail(const Parameters& parameters) {
  const std::string& kind = parameters.text("throws");
  if (kind == "standard") throw std::runtime_error("the moon is made of cheese");
  if (kind == "number") throw 42;
  if (kind == "memory") throw std::bad_alloc();
  if (kind == "input")
    throw fovea::Error(fovea::ExitCode::BadInput, "the moon is not full", "wait for a week");
}

class FaultyConstructor : public Pass {
 public:
  static PassDeclaration declaration() { return faulty("faulty-constructor"); }
  FaultyConstructor() { throw std::runtime_error("the moon is made of cheese"); }
};

class FaultyPrepare : public Pass {
 public:
  static PassDeclaration declaration() { return faulty("faulty-prepare"); }
  void prepare(PrepareContext& ctx) override { fail(ctx.parameters()); }
};

class FaultyRecord : public Pass {
 public:
  static PassDeclaration declaration() { return faulty("faulty-record"); }
  void record(RecordContext& ctx) override { fail(ctx.parameters()); }
};

class FaultyExecute : public Pass {
 public:
  static PassDeclaration declaration() { return faulty("faulty-execute", PassKind::Host); }
  void execute(HostContext& ctx) override { fail(ctx.parameters()); }
};

FOVEA_PASS(FaultyConstructor);
FOVEA_PASS(FaultyPrepare);
FOVEA_PASS(FaultyRecord);
FOVEA_PASS(FaultyExecute);

}  // namespace
