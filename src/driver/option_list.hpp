#pragma once

#include <ostream>
#include <vector>

#include "core/options.hpp"

namespace trocar::driver {

/// All options of the program. Options are declared nowhere else.
const std::vector<core::OptionSpec>& option_table();

/// The table as plain text, for -help.
void print_help(std::ostream& out);

/// The table as Markdown, for docs/options.md.
void print_markdown(std::ostream& out);

}  // namespace trocar::driver
