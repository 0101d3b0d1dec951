# Writes OUTPUT, a C++ file with what this build is. Run at every build; touches it only on change.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
file(WRITE ${OUTPUT}.new "#include \"driver/build_info.hpp\"\n
namespace trocar::driver::build_info {
const char* const version = \"${VERSION}\";
const char* const git_commit = \"${commit}\";
const char* const build_type = \"${BUILD_TYPE}\";
const char* const compiler = \"${COMPILER}\";
}  // namespace trocar::driver::build_info\n")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different ${OUTPUT}.new ${OUTPUT})
