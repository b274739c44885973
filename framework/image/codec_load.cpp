// Loads OpenImageIO with the first image that is read or written. Debian's build of it needs 230 other libraries, which
// the system takes 0.4 s to link; a command that reads no image finishes in a tenth of that.
#include <dlfcn.h>

#include <string>

#include "fovea/error.h"
#include "framework/base/paths.h"
#include "framework/image/codec.h"

namespace fovea::image::codec {

namespace {

[[noreturn]] void fail() {
  throw Error(ExitCode::BadInput, std::string("the image library cannot be loaded: ") + dlerror(),
              "install or build fovea again: this library belongs beside libfovea.so");
}

const Library& load() {
  const std::filesystem::path file = libraryFolder() / FOVEA_IMAGE_LIBRARY;
  void* handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!handle) fail();
  void* function = dlsym(handle, "fovea_image_library");
  if (!function) fail();
  return *reinterpret_cast<const Library* (*)()>(function)();
}

}  // namespace

const Library& library() {
  static const Library& loaded = load();
  return loaded;
}

}  // namespace fovea::image::codec
