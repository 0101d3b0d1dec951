#include "core/option_text.hpp"
#include "mutate.hpp"

namespace trocar::fuzz {
namespace {

const char* const scene =
    "# a scene\n-mesh build/meshes/gel.msh -fix bottom,x0:xz\n-gravity 0, 0, -9.81\n-time_step "
    "0.04\n"
    "-tissue_young 5e3 # Pa\n-output_fields \"\"\n-needles a,b\n-needle_a_entry 0,0.1,0\n-check\n"
    "-options_file \"other file.opts\"\n";

Tally tally("options");

}  // namespace
}  // namespace trocar::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace trocar;
  fuzz::Tally& tally = fuzz::tally;
  return fuzz::tried(tally, core::ExitCode::options, [&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto options = core::parse_option_text(text, "f.opts");
    ++tally.past_header;
    for (const core::WrittenOption& one : options) core::value_of(one, one.name == "gravity");
    ++tally.read;
    ++tally.accepted;
  });
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
{
  return trocar::fuzz::mutate_text(trocar::fuzz::scene, data, size, most, seed);
}
