# fovea_compile_by_folder(TARGET): the compiler sees the files of a folder as one, which takes it less than half of the
# time, as what they have in common is compiled once. So names in anonymous namespaces differ within a folder. With
# -D FOVEA_BY_FOLDER=OFF each file is compiled by itself: quicker after a change to one file, and for clang-tidy.
option(FOVEA_BY_FOLDER "Compile the files of a folder as one" ON)

function(fovea_compile_by_folder target)
  if(NOT FOVEA_BY_FOLDER)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE file)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER ${folder} folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Each file is the main file to GCC no longer, so that types of its own look to it like a header's.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
