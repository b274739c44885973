# What many files include is compiled once for a target instead of once for each file. Only headers of others are here,
# so that no change to the project compiles them again. -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON compiles without, as
# .ci/check-style does: each file has to include what it uses.
set(FOVEA_PRECOMPILED <algorithm> <array> <bit> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits>
  <map> <memory> <mutex> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view> <thread> <tuple>
  <unordered_map> <utility> <variant> <vector> <glm/glm.hpp> <glm/gtc/constants.hpp> <glm/gtc/packing.hpp>
  <glm/gtc/quaternion.hpp> <vulkan/vulkan.h>)

# ccache takes part in it if the compiler leaves a trace of the precompiled headers (GCC) or of no time (clang).
if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
elseif(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
endif()
