#include <cstdio>
#include <cstring>

#include "core/option_text.hpp"
#include "mutate.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace trocar::fuzz {
namespace {

const char* const scene =
    "# a scene\n-mesh build/meshes/gel.msh -fix bottom,x0:xz\n-gravity 0, 0, -9.81\n-time_step "
    "0.04\n"
    "-tissue_young 5e3 # Pa\n-output_fields \"\"\n-needles a,b\n-needle_a_entry 0,0.1,0\n-check\n"
    "-options_file \"other file.opts\"\n";

Tally& tally()
{
  static Tally all("options");
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
    const auto options = core::parse_option_text(text, "f.opts");
    ++tally.past_header;
    for (const core::WrittenOption& one : options) core::value_of(one, one.name == "gravity");
    ++tally.read;
    ++tally.accepted;
  } catch (const core::Failure& failure) {
    fuzz::require_one_line(failure, core::ExitCode::options);
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
