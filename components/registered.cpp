#include "components/registered.h"

#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

namespace pliant {
namespace {

// Registered entries of one kind. An entry is written under the lock; the count is raised afterwards.
template <class Value>
class Table {
 public:
  static constexpr std::size_t kMost = 32;
  struct Entry {
    std::string name;
    Value value;
  };

  explicit Table(const char* kind) : kind_(kind) {}

  // Returns the index of the new entry.
  Result<std::size_t> add(const std::string& name, Value value) {
    const std::string where = std::string(kind_) + " `" + name + "`";
    if (name.empty()) return Error{where, "has no name", "give it one"};
    const std::lock_guard lock(mutex_);
    const std::size_t count = count_.load();
    for (std::size_t i = 0; i < count; ++i)
      if (entries_[i].name == name) return Error{where, "is registered twice", "give each a name of its own"};
    if (count == kMost) return Error{where, "is one too many", "at most " + std::to_string(kMost) + " are taken"};
    entries_[count] = {name, std::move(value)};
    count_.store(count + 1);
    return count;
  }
  const Entry* find(std::size_t place) const { return place < count_.load() ? &entries_[place] : nullptr; }

 private:
  const char* kind_;
  std::mutex mutex_;
  std::atomic<std::size_t> count_{0};
  std::array<Entry, kMost> entries_;
};

Table<std::shared_ptr<const SpringFunction>>& springs() {
  static Table<std::shared_ptr<const SpringFunction>> table("spring law");
  return table;
}
Table<std::shared_ptr<const ShapeFunction>>& shapes() {
  static Table<std::shared_ptr<const ShapeFunction>> table("shape");
  return table;
}
Table<SolverFactory>& solvers() {
  static Table<SolverFactory> table("linear solver");
  return table;
}

template <class Enum>
std::size_t place_of(Enum value, Enum last) {  // indices of tables begin after the built-in ones
  return static_cast<std::size_t>(value) - static_cast<std::size_t>(last) - 1;
}
template <class Enum, class Value>
Result<Enum> added(Table<Value>& table, const std::string& name, Value value, Enum last,
                   const char* (*word_of_built_in)(Enum)) {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i)
    if (name == word_of_built_in(static_cast<Enum>(i)))
      return Error{"`" + name + "`", "is the name of a built-in one", "give it another"};
  const auto place = table.add(name, std::move(value));
  if (!place) return place.error();
  return static_cast<Enum>(static_cast<std::size_t>(last) + 1 + *place);
}

// Whether a derivative agrees with the central difference.
bool agrees(double derivative, double difference, double scale) {
  return std::abs(derivative - difference) <= 1e-3 * (std::abs(derivative) + scale);
}

const char* fault_of(const SpringFunction& law) {
  const SpringConstants constants{0.0, 100.0};
  constexpr double kMost = 0.02, kStep = 2e-4, kShort = 1e-6;  // [m]
  const auto F = [&](double h) { return law.force(h, constants); };
  const auto U = [&](double h) { return law.potential(h, constants); };
  if (!(std::abs(F(0.0)) < 1e-12) || !(std::abs(U(0.0)) < 1e-15)) return "is not zero at height 0";
  if (!(std::abs(law.slope(0.0, constants) - 1.0) < 1e-6)) return "has a slope other than 1 at height 0";
  for (double h = -kMost; h <= kMost; h += kStep) {
    const double slope = law.slope(h, constants);
    if (!std::isfinite(F(h)) || !std::isfinite(U(h)) || !std::isfinite(slope)) return "is not finite within 2 cm";
    if (!(slope > 0.0)) return "does not rise with height within 2 cm";
    if (std::abs(h) < 2 * kShort) continue;  // a law may have a kink there
    if (!agrees(F(h), (U(h + kShort) - U(h - kShort)) / (2 * kShort), 1e-4))
      return "has a potential that is not the integral of its force";
    if (!agrees(slope, (F(h + kShort) - F(h - kShort)) / (2 * kShort), 1.0))
      return "has a slope that is not the derivative of its force";
  }
  return nullptr;
}

const char* fault_of(const ShapeFunction& shape) {
  if (!(std::abs(shape.value(0.0) - 1.0) < 1e-6)) return "is not 1 where the contact is";
  if (!(std::abs(shape.value(1.0)) < 1e-6) || !(std::abs(shape.slope(1.0)) < 1e-4))
    return "does not go to zero, with its slope, at the reach";
  constexpr double kStep = 0.005, kShort = 1e-6;
  for (double u = kStep; u < 1.0; u += kStep) {
    if (!std::isfinite(shape.value(u)) || !std::isfinite(shape.slope(u))) return "is not finite";
    if (std::abs(shape.value(u)) > 1.0 + 1e-6) return "is larger than 1";
    if (!agrees(shape.slope(u), (shape.value(u + kShort) - shape.value(u - kShort)) / (2 * kShort), 0.1))
      return "has a slope that is not its derivative by u";
  }
  return nullptr;
}

}  // namespace

const SpringFunction* registered_spring(SpringLaw law) {
  const auto* entry = springs().find(place_of(law, kLastSpring));
  return entry ? entry->value.get() : nullptr;
}
const ShapeFunction* registered_shape(Shape shape) {
  const auto* entry = shapes().find(place_of(shape, kLastShape));
  return entry ? entry->value.get() : nullptr;
}
const SolverFactory* registered_solver(SolverKind kind) {
  const auto* entry = solvers().find(place_of(kind, kLastSolver));
  return entry ? &entry->value : nullptr;
}
const char* registered_word(SpringLaw law) {
  const auto* entry = springs().find(place_of(law, kLastSpring));
  return entry ? entry->name.c_str() : nullptr;
}
const char* registered_word(Shape shape) {
  const auto* entry = shapes().find(place_of(shape, kLastShape));
  return entry ? entry->name.c_str() : nullptr;
}
const char* registered_word(SolverKind kind) {
  const auto* entry = solvers().find(place_of(kind, kLastSolver));
  return entry ? entry->name.c_str() : nullptr;
}

Result<SpringLaw> register_spring(const std::string& name, std::shared_ptr<const SpringFunction> function) {
  const std::string where = "spring law `" + name + "`";
  if (!function) return Error{where, "has no function", "give one"};
  if (const char* fault = fault_of(*function)) return Error{where, std::string(fault), "see pliant/surface_law.h"};
  return added<SpringLaw>(springs(), name, std::move(function), kLastSpring, word_of);
}

Result<Shape> register_shape(const std::string& name, std::shared_ptr<const ShapeFunction> function) {
  const std::string where = "shape `" + name + "`";
  if (!function) return Error{where, "has no function", "give one"};
  if (const char* fault = fault_of(*function)) return Error{where, std::string(fault), "see pliant/surface_law.h"};
  return added<Shape>(shapes(), name, std::move(function), kLastShape, word_of);
}

Result<SolverKind> register_solver(const std::string& name, SolverFactory factory) {
  if (!factory) return Error{"linear solver `" + name + "`", "has no factory", "give a function that makes one"};
  return added<SolverKind>(solvers(), name, std::move(factory), kLastSolver, word_of);
}

}  // namespace pliant
