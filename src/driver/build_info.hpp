#pragma once

namespace trocar::driver::build_info {

// Defined in a source file that CMake writes at build time (cmake -P scripts/build_info.cmake).
extern const char* const version;
extern const char* const git_commit;  ///< with "-dirty" when the working tree had changes
extern const char* const build_type;
extern const char* const compiler;

}  // namespace trocar::driver::build_info
