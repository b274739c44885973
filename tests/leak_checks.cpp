// Options for LeakSanitizer, however a test or fuzz target is started. A build without sanitizers calls none of this.

// Up to LLVM 16 the runtime may take a block of thread-local memory for one of glibc before 2.25, reads its place and
// size from what lies in front of it, and crashes there. Without the interceptor it finds such blocks as it does all
// memory: from the thread's table of them. The slower way to follow calls goes through libraries without frame pointers,
// so that a leak shows which of them it is in.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0:fast_unwind_on_malloc=0"; }

extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

// What libraries leak: OpenImageIO's PNG reader leaves a broken file by longjmp, past a string. The
// suppression names the library, because names of functions need a symbolizer of the compiler's version.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOpenImageIO.so\n"; }
