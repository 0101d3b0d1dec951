#include "core/csv.hpp"
#include "mutate.hpp"

namespace trocar::fuzz {
namespace {

const char* const scene = "# a ramp\ntime,factor\n0,0\n0.5,1e-3\n1,1\n2.5,-4\n";

Tally tally("csv");

}  // namespace
}  // namespace trocar::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace trocar;
  fuzz::Tally& tally = fuzz::tally;
  return fuzz::tried(tally, core::ExitCode::data, [&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find("time,factor\n") != std::string::npos) ++tally.past_header;
    const core::Csv table = core::parse_csv(text, "f.csv");
    core::require_time_column(table);
    ++tally.read;
    if (table.columns.size() < 2) return;
    core::interpolate(table, 1, 0.7);
    ++tally.accepted;
  });
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
{
  return trocar::fuzz::mutate_text(trocar::fuzz::scene, data, size, most, seed);
}
