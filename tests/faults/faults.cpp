// Makes functions of the system and of the C++ library fail (fault.h). A test puts this library before the others
// (LD_PRELOAD).
#include <dlfcn.h>
#include <link.h>
#include <pthread.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include "fault.h"

namespace {

// Whether code of this project is at an address. Drivers and other libraries do not survive a lack of memory, and what
// they make of it is not what the tests are about.
bool isOurs(const void* code) {
  struct Range {
    uintptr_t begin = 0, end = 0;
  };
  struct Ranges {
    Range all[8];
    int count = 0;
  };
  static const Ranges ours = [] {
    Ranges ranges;
    dl_iterate_phdr(
        [](dl_phdr_info* module, size_t, void* data) {
          auto& found = *static_cast<Ranges*>(data);
          const bool program = found.count == 0;  // which comes first and has no name
          if (!program && !std::strstr(module->dlpi_name, "libfovea")) return 0;
          for (int i = 0; i < module->dlpi_phnum && found.count < 8; ++i) {
            const auto& segment = module->dlpi_phdr[i];
            if (segment.p_type != PT_LOAD || !(segment.p_flags & PF_X)) continue;
            const uintptr_t begin = module->dlpi_addr + segment.p_vaddr;
            found.all[found.count++] = {begin, begin + segment.p_memsz};
          }
          return 0;
        },
        &ranges);
    return ranges;
  }();
  const auto at = reinterpret_cast<uintptr_t>(code);
  for (int i = 0; i < ours.count; ++i)
    if (at >= ours.all[i].begin && at < ours.all[i].end) return true;
  return false;
}

using Main = int (*)(int, char**, char**);
Main mainOfTheProgram = nullptr;
thread_local bool counts =
    false;  // in main(), before which nothing can catch what is thrown, and in std::thread

int runMain(int argc, char** argv, char** environment) {
  counts = true;
  return mainOfTheProgram(argc, argv, environment);
}

void* allocate(size_t bytes, const void* caller) {
  if (counts && isOurs(caller)) {
    counts = false;  // making the fault allocates memory
    static Fault fault("new");
    const bool fails = fault.next().has_value();
    counts = true;
    if (fails) throw std::bad_alloc();
  }
  void* const memory = std::malloc(bytes > 0 ? bytes : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(size_t bytes) { return allocate(bytes, __builtin_return_address(0)); }
void* operator new[](size_t bytes) { return allocate(bytes, __builtin_return_address(0)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }

extern "C" int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                                 void (*loaderFini)(), void* stackEnd) {
  mainOfTheProgram = main;
  return reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"))(
      runMain, argc, argv, init, fini, loaderFini, stackEnd);
}

struct Start {
  void* (*function)(void*);
  void* argument;
};

void* startCounting(void* data) {
  const Start start = *static_cast<Start*>(data);
  std::free(data);
  counts = true;
  return start.function(start.argument);
}

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) {
  static Fault fault("pthread_create");
  static void* const function = dlsym(RTLD_NEXT, "pthread_create");
  if (const auto result = fault.next()) return *result;
  const auto create = reinterpret_cast<decltype(&pthread_create)>(function);
  Dl_info caller;
  if (!counts || !dladdr(__builtin_return_address(0), &caller) || !std::strstr(caller.dli_fname, "libstdc++"))
    return create(thread, attributes, start, argument);
  return create(thread, attributes, startCounting, new (std::malloc(sizeof(Start))) Start{start, argument});
}
