// A shared library that has nothing to do with fovea, and must never be run.
#include <cstdlib>

[[gnu::constructor]] static void run() { std::abort(); }
