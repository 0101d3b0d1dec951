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

/// Parses the text of a CSV file: one header line, then at least one row of finite numbers. Blank
/// lines and lines that begin with '#' are skipped. Throws Failure (65) naming file, line and
/// column.
Csv parse_csv(const std::string& text, const std::string& file);

/// Throws Failure (65) unless the first column is `time` and strictly increasing.
void require_time_column(const Csv& table);

/// Value of column `column` at time t: linear between rows, constant before the first and after the
/// last row.
double interpolate(const Csv& table, std::size_t column, double t);

}  // namespace trocar::core
