#include "core/csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/failure.hpp"
#include "core/words.hpp"

namespace trocar::core {
namespace {

double finite_number(const std::string& cell, const std::string& where)
{
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (cell.empty() || *end != '\0') throw data_error(where + ": '" + cell + "' is not a number");
  if (!std::isfinite(value)) throw data_error(where + ": '" + cell + "' is not finite");
  return value;
}

}  // namespace

Csv parse_csv(const std::string& text, const std::string& file)
{
  Csv table{file, {}, {}};
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string> cells = split(line, ',');
    if (cells.empty() || line.front() == '#') continue;
    if (table.columns.empty()) {
      table.columns = cells;
      continue;
    }
    const std::string where = file + " line " + std::to_string(number);
    if (cells.size() != table.columns.size())
      throw data_error(where + ": " + std::to_string(cells.size()) + " columns, the header has " +
                       std::to_string(table.columns.size()));
    std::vector<double> row;
    for (std::size_t c = 0; c < cells.size(); ++c)
      row.push_back(finite_number(cells[c], where + ", column " + table.columns[c]));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) throw data_error(file + ": no rows (a header line and rows are needed)");
  return table;
}

void require_time_column(const Csv& table)
{
  if (table.columns.front() != "time")
    throw data_error(table.file + ": the first column must be 'time', it is '" +
                     table.columns.front() + "'");
  for (std::size_t i = 1; i < table.rows.size(); ++i)
    if (table.rows[i].front() <= table.rows[i - 1].front())
      throw data_error(table.file + ": time does not increase at row " + std::to_string(i + 1));
}

double interpolate(const Csv& table, std::size_t column, double t)
{
  const auto& rows = table.rows;
  if (t <= rows.front().front()) return rows.front()[column];
  if (t >= rows.back().front()) return rows.back()[column];
  const auto after = std::upper_bound(rows.begin(), rows.end(), t,
                                      [](double v, const auto& row) { return v < row.front(); });
  const auto& b = *after;
  const auto& a = *(after - 1);
  const double w = (t - a.front()) / (b.front() - a.front());
  return (1.0 - w) * a[column] + w * b[column];
}

}  // namespace trocar::core
