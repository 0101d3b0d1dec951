#pragma once

#include <string>
#include <vector>

namespace trocar::core {

/// A table of finite numbers with a header line.
struct Csv
{
  std::string file;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< rows[i].size() == columns.size()
};

/// Parses the text of a CSV file: one header line, then rows of finite numbers; blank lines and
/// lines that begin with '#' are skipped. Throws Failure (65) naming file, line and column.
Csv parse_csv(const std::string& text, const std::string& file);

/// Checks that the first column is `time`, strictly increasing, and that there is a row.
void require_time_column(const Csv& table);

/// Value of column `column` at time t: linear between rows, held before the first and after the
/// last one.
double interpolate(const Csv& table, std::size_t column, double t);

}  // namespace trocar::core
