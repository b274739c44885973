# Kernels of passes that trace rays, compiled for the host (framework/host/kernel.h).
# Shaders construct records as Record(a, b), which C++20 allows and older compilers do not know.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -std=c++20)
check_cxx_source_compiles("struct R { float a, b; }; int main() { return int(R(1, 2).a); }"
  FOVEA_PARENTHESES_MAKE_RECORDS)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT FOVEA_PARENTHESES_MAKE_RECORDS)
  message(FATAL_ERROR "${CMAKE_CXX_COMPILER} (${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}) cannot compile "
    "shaders for the host: it does not initialize aggregates in parentheses (C++20, P0960). Use GCC 10, clang 16 or newer.")
endif()

# Literals have no suffix in GLSL.
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  set(FOVEA_FLOAT_LITERALS -Xclang -cl-single-precision-constant)
else()
  set(FOVEA_FLOAT_LITERALS -fsingle-precision-constant)
endif()

# fovea_host_shaders(<source>...): the sources include shaders (shaders/device/language.h).
function(fovea_host_shaders)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
    COMPILE_OPTIONS "${FOVEA_FLOAT_LITERALS};-fno-math-errno;-Wno-unused;-Wno-unused-parameter"
    INCLUDE_DIRECTORIES "${PROJECT_SOURCE_DIR}/shaders;${PROJECT_SOURCE_DIR}/passes")
endfunction()

# fovea_host_kernel(<target> <shader> [<macro>=<value>,<value>...]...): the shader, such as gbuffer/resolve.comp, with
# each combination of the values of its macros, becomes a source file of the target.
function(fovea_host_kernel target shader)
  set(variants "")
  list(APPEND variants "-")
  foreach(macro ${ARGN})
    string(REGEX MATCH "^([A-Z_]+)=(.*)$" matched "${macro}")
    string(REPLACE "," ";" values "${CMAKE_MATCH_2}")
    set(name ${CMAKE_MATCH_1})
    set(more "")
    foreach(variant ${variants})
      foreach(value ${values})
        list(APPEND more "${variant} ${name}=${value}")
      endforeach()
    endforeach()
    set(variants ${more})
  endforeach()
  foreach(variant ${variants})
    set(FOVEA_MACROS "")
    set(FOVEA_DEFINES "")
    set(FOVEA_PASSING Never)
    string(REGEX MATCHALL "[A-Z_]+=[0-9]+" pairs "${variant}")
    foreach(pair ${pairs})
      string(REPLACE "=" ";" parts ${pair})
      list(GET parts 0 name)
      list(GET parts 1 value)
      string(APPEND FOVEA_MACROS "#define ${name} ${value}\n")
      string(APPEND FOVEA_DEFINES "{\"${name}\", \"${value}\"}, ")
      if(pair STREQUAL "RAY_PASSAGE=1")
        set(FOVEA_PASSING Met)
      endif()
    endforeach()
    set(FOVEA_SHADER ${shader})
    string(REGEX REPLACE "[^A-Za-z0-9]+" "_" file "${shader}_${variant}")
    set(file ${CMAKE_CURRENT_BINARY_DIR}/host_kernels/${file}.cpp)
    configure_file(${PROJECT_SOURCE_DIR}/framework/cmake/host_kernel.cpp.in ${file} @ONLY)
    target_sources(${target} PRIVATE ${file})
    fovea_host_shaders(${file})
  endforeach()
endfunction()
