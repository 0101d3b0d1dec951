#include <cstdio>
#include <cstring>

#include "core/csv.hpp"
#include "mutate.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace trocar::fuzz {
namespace {

const char* const scene = "# a ramp\ntime,factor\n0,0\n0.5,1e-3\n1,1\n2.5,-4\n";

Tally& tally()
{
  static Tally all("csv");
  return all;
}

}  // namespace
}  // namespace trocar::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace trocar;
  fuzz::Tally& tally = fuzz::tally();
  ++tally.inputs;
  try {
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find("time,factor\n") != std::string::npos) ++tally.past_header;
    const core::Csv table = core::parse_csv(text, "f.csv");
    core::require_time_column(table);
    ++tally.read;
    if (table.columns.size() < 2) return 0;
    core::interpolate(table, 1, 0.7);
    ++tally.accepted;
  } catch (const core::Failure& failure) {
    fuzz::require_one_line(failure, core::ExitCode::data);
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
{
  using namespace trocar::fuzz;
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (below(random, 4) == 0 || size < 5) text = scene;
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    const std::size_t kind = below(random, 8);
    if (kind == 7) return LLVMFuzzerMutate(data, size, most);
    text = kind < 4 ? change_word(text, random) : change_lines(text, random);
  }
  text.resize(std::min(text.size(), most));
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
