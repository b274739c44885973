# fovea_add_library(NAME SOURCES...): the shared library libfovea-NAME.so as the target fovea::NAME, of passes or scenes that
# register themselves. Its public header is include/fovea/NAME.h beside the CMakeLists.txt. It declares registerAll(),
# which whoever links the library calls: the call is what makes a linker that leaves out libraries of which nothing is
# used (--as-needed) keep this one.
function(fovea_add_library name)
  add_library(fovea_${name} SHARED ${ARGN})
  add_library(fovea::${name} ALIAS fovea_${name})
  set_target_properties(fovea_${name} PROPERTIES OUTPUT_NAME fovea-${name} EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} INSTALL_RPATH "$ORIGIN"
    DEFINE_SYMBOL "")  # nobody asks for it
  target_include_directories(fovea_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(fovea_${name} PUBLIC fovea::fovea)
  if(NOT FOVEA_SANITIZE)  # whose functions are found when the program runs
    target_link_options(fovea_${name} PRIVATE LINKER:--no-undefined)
  endif()
  install(TARGETS fovea_${name} EXPORT fovea-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/include/fovea DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()
