# Writes kPassSources and kBuildCommit (pass_code.h): cmake -DSOURCE=.. -DOUTPUT=.. -P pass_sources.cmake
cmake_minimum_required(VERSION 3.25)
set(entries "")
file(GLOB folders LIST_DIRECTORIES true ${SOURCE}/passes/*)
foreach(folder ${folders})
  if(IS_DIRECTORY ${folder})
    file(GLOB files ${folder}/*.cpp ${folder}/*.h)
    set(all "")
    foreach(file ${files})
      file(SHA256 ${file} hash)
      cmake_path(GET file FILENAME name)
      string(APPEND all "${name} ${hash}\n")
    endforeach()
    string(SHA256 hash "${all}")
    string(SUBSTRING ${hash} 0 16 hash)
    cmake_path(GET folder FILENAME type)
    string(APPEND entries "    {\"${type}\", \"${hash}\"},\n")
  endif()
endforeach()
set(commit "")
execute_process(COMMAND git -C ${SOURCE} rev-parse --short HEAD OUTPUT_VARIABLE commit ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
file(WRITE ${OUTPUT} "#include \"samples/fovea/pass_code.h\"

namespace fovea::cli {

const std::vector<std::pair<std::string_view, std::string_view>> kPassSources = {
${entries}};
const std::string_view kBuildCommit = \"${commit}\";

}  // namespace fovea::cli
")
