#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>

#include "io/msh_mesh.hpp"
#include "mesh/soundness.hpp"
#include "mutate.hpp"

namespace trocar::fuzz {
namespace {

/// Writes fields as text or as bytes.
class Writer
{
 public:
  explicit Writer(bool binary) : binary_(binary) {}
  void text(const std::string& words) { all_ += words; }
  void integer(std::int32_t value) { field(value); }
  void size(std::int64_t value) { field(value); }
  void real(double value) { field(value); }
  void line() { all_ += binary_ ? "" : "\n"; }
  const std::string& all() const { return all_; }

 private:
  template <class Number>
  void field(Number value)
  {
    if (!binary_) {
      all_ += std::to_string(value) + " ";
      return;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    all_.append(bytes, sizeof value);
  }
  bool binary_;
  std::string all_;
};

constexpr double nodes[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
constexpr int tets[2][4] = {{1, 2, 3, 4}, {2, 3, 4, 5}};
constexpr int faces[2][3] = {{1, 2, 3}, {2, 3, 5}};

void begin(Writer& out, const char* version, bool binary)
{
  out.text(std::string("$MeshFormat\n") + version + (binary ? " 1 8\n" : " 0 8\n"));
  if (binary) out.integer(1);
  out.text(std::string(binary ? "\n" : "") +
           "$EndMeshFormat\n$PhysicalNames\n3\n0 2 \"tip\"\n2 5 \"skin\"\n3 1 \"gel\"\n"
           "$EndPhysicalNames\n");
}

std::string of_version_4(bool binary)
{
  Writer out(binary);
  begin(out, "4.1", binary);
  out.text("$Entities\n");
  for (int n : {1, 0, 1, 1}) out.size(n);
  out.line();
  const auto entity = [&](int tag, int numbers, int group) {
    out.integer(tag);
    for (int k = 0; k < numbers; ++k) out.real(0.5);
    out.size(1);
    out.integer(group);
    if (numbers > 3) out.size(0);
    out.line();
  };
  entity(4, 3, 2), entity(9, 6, 5), entity(1, 6, 1);
  out.text("\n$EndEntities\n$Nodes\n");
  for (int n : {1, 5, 1, 5}) out.size(n);
  out.line();
  out.integer(3), out.integer(1), out.integer(0), out.size(5), out.line();
  for (int n = 1; n <= 5; ++n) out.size(n), out.line();
  for (const auto& x : nodes) {
    for (double value : x) out.real(value);
    out.line();
  }
  out.text("\n$EndNodes\n$Elements\n");
  for (int n : {3, 5, 1, 5}) out.size(n);
  out.line();
  const auto block = [&](int dim, int tag, int type, int count) {
    out.integer(dim), out.integer(tag), out.integer(type), out.size(count), out.line();
  };
  block(0, 4, 15, 1), out.size(1), out.size(4), out.line();
  block(2, 9, 2, 2);
  for (int i = 0; i < 2; ++i) {
    out.size(2 + i);
    for (int n : faces[i]) out.size(n);
    out.line();
  }
  block(3, 1, 4, 2);
  for (int i = 0; i < 2; ++i) {
    out.size(4 + i);
    for (int n : tets[i]) out.size(n);
    out.line();
  }
  out.text("\n$EndElements\n");
  return out.all();
}

std::string of_version_2(bool binary)
{
  Writer out(binary);
  begin(out, "2.2", binary);
  out.text("$Nodes\n5\n");
  for (int n = 0; n < 5; ++n) {
    out.integer(n + 1);
    for (double value : nodes[n]) out.real(value);
    out.line();
  }
  out.text("\n$EndNodes\n$Elements\n4\n");
  const auto element = [&](int number, int type, int group, const int* at, int count) {
    if (binary) out.integer(type), out.integer(1), out.integer(2), out.integer(number);
    if (!binary) out.integer(number), out.integer(type), out.integer(2);
    out.integer(group), out.integer(group);
    for (int k = 0; k < count; ++k) out.integer(at[k]);
    out.line();
  };
  for (int i = 0; i < 2; ++i) element(1 + i, 2, 5, faces[i], 3);
  for (int i = 0; i < 2; ++i) element(3 + i, 4, 1, tets[i], 4);
  out.text("\n$EndElements\n");
  return out.all();
}

/// A file in memory, whose path the reader is given.
std::string file_with(const std::uint8_t* data, std::size_t size)
{
  static const int number = ::memfd_create("mesh", 0);
  if (::ftruncate(number, 0) != 0 || ::pwrite(number, data, size, 0) != static_cast<ssize_t>(size))
    __builtin_trap();
  return "/proc/self/fd/" + std::to_string(number);
}

bool past_header(const std::uint8_t* data, std::size_t size)
{
  const std::string text(reinterpret_cast<const char*>(data), std::min<std::size_t>(size, 60));
  return text.rfind("$MeshFormat\n4.1 ", 0) == 0 || text.rfind("$MeshFormat\n2.2 ", 0) == 0;
}

Tally tally("mesh");

}  // namespace
}  // namespace trocar::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace trocar;
  fuzz::Tally& tally = fuzz::tally;
  if (fuzz::past_header(data, size)) ++tally.past_header;
  return fuzz::tried(tally, core::ExitCode::data, [&] {
    const io::MshFile file = io::read_msh(fuzz::file_with(data, size));
    ++tally.read;
    mesh::Mesh mesh = io::mesh_of(file, 1e-3);
    mesh::drop_repeated(mesh);
    mesh.index_middles();
    mesh::validate(mesh);
    mesh::judge(mesh);
    ++tally.accepted;
  });
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
{
  using namespace trocar::fuzz;
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (below(random, 4) == 0 || size < 20) {
    const bool binary = below(random, 2);
    text = below(random, 2) ? of_version_4(binary) : of_version_2(binary);
  }
  const bool binary = text.find(" 1 8\n") < 30;
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    const std::size_t kind = below(random, 8);
    if (kind < 4)
      text = binary ? change_bytes(text, random) : change_word(text, random);
    else if (kind < 7)
      text = change_lines(text, random);
    else
      return LLVMFuzzerMutate(data, size, most);
  }
  text.resize(std::min(text.size(), most));
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
