// Makes functions of the system fail (fault.h). A test puts this library before the others (LD_PRELOAD).
#include <dlfcn.h>
#include <pthread.h>

#include "fault.h"

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) {
  static Fault fault("pthread_create");
  static void* const function = dlsym(RTLD_NEXT, "pthread_create");
  if (const auto result = fault.next()) return *result;
  return reinterpret_cast<decltype(&pthread_create)>(function)(thread, attributes, start, argument);
}
