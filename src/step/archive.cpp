#include "step/archive.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/visit.hpp"
#include "step/state_indices.hpp"

namespace trocar::step {
namespace {

template <class T>
struct is_by_point : std::false_type
{
};
template <class List>
struct is_by_point<fem::ByPoint<List>> : std::true_type
{
};

/// Numbers in one value of a list: 1 for a scalar, all entries for an Eigen vector or matrix.
template <class Value>
constexpr std::size_t width()
{
  if constexpr (core::Number<Value>)
    return 1;
  else
    return static_cast<std::size_t>(Value::SizeAtCompileTime);
}

template <class List>
using ValueOf = std::remove_cvref_t<decltype(std::declval<List&>()[0])>;

/// View of the numbers of a list in memory. Borrows the list.
template <class List>
std::span<const double> numbers_of(const List& list)
{
  const auto size = static_cast<std::size_t>(list.size());
  if (size == 0) return {};
  return {reinterpret_cast<const double*>(list.data()), size * width<ValueOf<List>>()};
}

/// Leaf visitor of core::Walk that writes the leaves of a state into an archive.
class Writer
{
 public:
  explicit Writer(const fem::Space& space) : space_(&space) {}

  template <class T>
  void value(const std::string& name, const char* unit, const T& x)
  {
    archive_.names.push_back(name + " [" + unit + "]");
    if constexpr (std::is_same_v<T, fem::OwnedField>) {
      const fem::GlobalField all = space_->gather(x);
      archive_.fields.push_back(
          {name, unit, {all.value.data(), all.value.data() + all.value.size()}});
    } else if constexpr (is_by_point<T>::value) {
      archive_.fields.push_back({name, unit, space_->gather_tets(numbers_of(x.list))});
    } else if constexpr (core::Number<T>) {
      number(x);
    } else {
      archive_.whole.push_back(static_cast<long long>(x.size()));
      if constexpr (requires { x.rows(); })
        std::for_each(x.data(), x.data() + x.size(), [&](double one) { number(one); });
      else
        for (const auto& one : x) number(one);
    }
  }
  template <class T>
  void resize(const std::string& name, const T& list)
  {
    archive_.names.push_back(name);
    archive_.whole.push_back(static_cast<long long>(list.size()));
  }
  template <class T>
  void present(const std::string& name, const T& part)
  {
    archive_.names.push_back(name);
    archive_.whole.push_back(part ? 1 : 0);
  }

  core::Archive take() { return std::move(archive_); }

 private:
  template <class T>
  void number(const T& x)
  {
    if constexpr (std::is_floating_point_v<T>)
      archive_.real.push_back(x);
    else
      archive_.whole.push_back(static_cast<long long>(x));
  }

  const fem::Space* space_;
  core::Archive archive_;
};

/// Leaf visitor of core::Walk that reads the leaves of a state from an archive. The archive may be
/// damaged or from another version, so names and sizes are checked. Throws Failure (65).
class Reader
{
 public:
  Reader(const core::Archive& archive, const fem::Space& space) : archive_(&archive), space_(&space)
  {
  }

  template <class T>
  void value(const std::string& name, const char* unit, T& x)
  {
    expect(name + " [" + unit + "]");
    if constexpr (std::is_same_v<T, fem::OwnedField>) {
      const std::vector<double>& all = field(name, 3 * static_cast<std::size_t>(space_->global()));
      const fem::GlobalField global{
          Eigen::Map<const core::VecX>(all.data(), static_cast<Eigen::Index>(all.size()))};
      x = space_->restrict_to_owned(global);
    } else if constexpr (is_by_point<T>::value) {
      fill(x.list, field(name, 0));
    } else if constexpr (core::Number<T>) {
      number(x);
    } else {
      resize_to(x, size());
      if constexpr (requires { x.rows(); })
        std::for_each(x.data(), x.data() + x.size(), [&](double& one) { number(one); });
      else
        for (auto& one : x) number(one);
    }
  }
  template <class T>
  void resize(const std::string& name, T& list)
  {
    expect(name);
    list.resize(size());
  }
  template <class T>
  void present(const std::string& name, T& part)
  {
    expect(name);
    if (size() > 0) part.emplace();
  }
  /// Throws Failure (65) when the archive has entries that were not read.
  void finish() const
  {
    if (name_ != archive_->names.size() || whole_ != archive_->whole.size() ||
        real_ != archive_->real.size() || field_ != archive_->fields.size())
      throw core::data_error("it tells more than a state has");
  }

 private:
  void expect(const std::string& name)
  {
    if (name_ >= archive_->names.size() || archive_->names[name_] != name)
      throw core::data_error("it does not tell " + name +
                             ", or not in its turn: another version may have written it");
    ++name_;
  }
  template <class T>
  const T& next(const std::vector<T>& list, std::size_t& at) const
  {
    if (at >= list.size()) throw core::data_error("numbers are missing");
    return list[at++];
  }
  template <class T>
  void number(T& x)
  {
    if constexpr (std::is_floating_point_v<T>)
      x = next(archive_->real, real_);
    else {
      const long long value = next(archive_->whole, whole_);
      x = static_cast<T>(value);
      if (static_cast<long long>(x) != value) throw core::data_error("a number of it is too large");
    }
  }
  /// Size of the next list, or 1 or 0 for an optional part. A size above the number of all entries
  /// of the archive is damage: throws Failure (65) before memory is allocated for it.
  std::size_t size()
  {
    const long long asked = next(archive_->whole, whole_);
    const std::size_t most =
        archive_->names.size() + archive_->whole.size() + archive_->real.size();
    if (asked < 0 || static_cast<std::size_t>(asked) > most)
      throw core::data_error("a list of it has no such size");
    return static_cast<std::size_t>(asked);
  }
  template <class T>
  static void resize_to(T& x, std::size_t size)
  {
    if constexpr (requires { x.rows(); }) {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic)
        x.resize(static_cast<Eigen::Index>(size));
      else if (size != static_cast<std::size_t>(T::SizeAtCompileTime))
        throw core::data_error("a list of it has no such size");
    } else {
      x.resize(size);
    }
  }
  /// Values of the next field, which must have this name and `size` numbers; size 0: any number.
  const std::vector<double>& field(const std::string& name, std::size_t size)
  {
    const core::Archive::Field& found = next(archive_->fields, field_);
    if (found.name != name || (size > 0 && found.values.size() != size))
      throw core::data_error("its field " + name + " is not one of this mesh");
    return found.values;
  }
  template <class List>
  void fill(List& list, const std::vector<double>& all) const
  {
    constexpr std::size_t each = width<ValueOf<List>>();
    const std::size_t tets = static_cast<std::size_t>(space_->tets_of_mesh());
    if (all.size() % (tets * each) != 0) throw core::data_error("a list by tet has no such size");
    const std::vector<double> mine = space_->of_local_tets(all);
    resize_to(list, mine.size() / each);
    if (!mine.empty()) std::copy(mine.begin(), mine.end(), reinterpret_cast<double*>(list.data()));
  }

  const core::Archive* archive_;
  const fem::Space* space_;
  std::size_t name_ = 0, whole_ = 0, real_ = 0, field_ = 0;
};

}  // namespace

core::Archive archived(const State& state, const fem::Space& space)
{
  Writer writer(space);
  core::Walk walk(writer);
  State::visit(state, walk);
  return writer.take();
}

State restored(core::Archive archive, const fem::Space& space)
{
  const base::Comm& comm = space.comm();
  comm.broadcast(archive.names);
  comm.broadcast(archive.whole);
  comm.broadcast(archive.real);
  std::vector<std::string> fields;
  for (const core::Archive::Field& field : archive.fields) fields.push_back(field.name);
  comm.broadcast(fields);
  archive.fields.resize(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    archive.fields[i].name = fields[i];
    comm.broadcast(archive.fields[i].values);
  }
  State state;
  Reader reader(archive, space);
  core::Walk walk(reader);
  State::visit(state, walk);
  reader.finish();
  refuse_indices_of_nothing(state, space);
  return state;
}

}  // namespace trocar::step
