#include "components/registered.h"

#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

#include "components/has_word.h"

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

// The enumerators are the first rows, in their order.
template <class Row, std::size_t size, class Enum>
constexpr bool has(const Row (&rows)[size], Enum value, std::string_view word) {
  return static_cast<std::size_t>(value) < size && rows[static_cast<std::size_t>(value)].word == word;
}
static_assert(has(kSpringRows, SpringLaw::kLinear, "linear") && has(kSpringRows, SpringLaw::kCubic, "cubic") &&
              has(kSpringRows, SpringLaw::kExponential, "exponential") &&
              has(kSpringRows, SpringLaw::kStandardLinearSolid, "sls") &&
              has(kSpringRows, SpringLaw::kTable, "table") &&
              has(kSpringRows, SpringLaw::kQuasiLinearCubic, "qlv_cubic") &&
              has(kSpringRows, SpringLaw::kQuasiLinearExponential, "qlv_exponential") &&
              has(kSpringRows, SpringLaw::kQuasiLinearTable, "qlv_table"));
static_assert(has(kShapeRows, Shape::kPunch, "punch") && has(kShapeRows, Shape::kHertz, "hertz") &&
              has(kShapeRows, Shape::kGaussian, "gaussian") && has(kShapeRows, Shape::kWendland, "wendland") &&
              has(kShapeRows, Shape::kVolume, "volume") && has(kShapeRows, Shape::kKelvinlet, "kelvinlet"));
static_assert(has(kSolverRows, SolverKind::kAuto, "auto") &&
              has(kSolverRows, SolverKind::kBlockCholesky, "block_cholesky") &&
              has(kSolverRows, SolverKind::kEigenCholesky, "eigen_cholesky") &&
              has(kSolverRows, SolverKind::kCholmod, "cholmod") &&
              has(kSolverRows, SolverKind::kConjugateGradient, "conjugate_gradient") &&
              has(kSolverRows, SolverKind::kDense, "dense"));

// Registered ones are numbered after those that ship.
template <class Row, std::size_t size, class Enum, class Value>
Result<Enum> added(const Row (&rows)[size], Table<Value>& table, const std::string& name, Value value) {
  for (const Row& row : rows)
    if (name == row.word) return Error{"`" + name + "`", "is the name of a built-in one", "give it another"};
  const auto place = table.add(name, std::move(value));
  if (!place) return place.error();
  return static_cast<Enum>(size + *place);
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
  const auto* entry = springs().find(static_cast<std::size_t>(law) - std::size(kSpringRows));
  return entry ? entry->value.get() : nullptr;
}
const ShapeFunction* registered_shape(Shape shape) {
  const auto* entry = shapes().find(static_cast<std::size_t>(shape) - std::size(kShapeRows));
  return entry ? entry->value.get() : nullptr;
}
const SolverFactory* registered_solver(SolverKind kind) {
  const auto* entry = solvers().find(static_cast<std::size_t>(kind) - std::size(kSolverRows));
  return entry ? &entry->value : nullptr;
}
const char* registered_word(SpringLaw law) {
  const auto* entry = springs().find(static_cast<std::size_t>(law) - std::size(kSpringRows));
  return entry ? entry->name.c_str() : nullptr;
}
const char* registered_word(Shape shape) {
  const auto* entry = shapes().find(static_cast<std::size_t>(shape) - std::size(kShapeRows));
  return entry ? entry->name.c_str() : nullptr;
}
const char* registered_word(SolverKind kind) {
  const auto* entry = solvers().find(static_cast<std::size_t>(kind) - std::size(kSolverRows));
  return entry ? entry->name.c_str() : nullptr;
}

bool reads_key(SpringLaw law, const char* key) {
  return has_word(row_of(law).reads, key);
}

// The difference of the potential; where it would cancel, the mean of the force (Gauss-Legendre, four points).
double SpringFunction::mean_force(double h0, double h1, const SpringConstants& constants) const {
  const double d = h1 - h0;
  if (std::abs(d) > 1e-3 * (std::abs(h0) + std::abs(h1)))
    return (potential(h1, constants) - potential(h0, constants)) / d;
  constexpr double kAt[2] = {0.3399810435848563, 0.8611363115940526};
  constexpr double kWeight[2] = {0.6521451548625461, 0.3478548451374538};
  const double middle = 0.5 * (h0 + h1);
  double sum = 0.0;
  for (int i = 0; i < 2; ++i)
    sum += kWeight[i] * (force(middle - 0.5 * d * kAt[i], constants) + force(middle + 0.5 * d * kAt[i], constants));
  return 0.5 * sum;
}

Result<SpringLaw> register_spring(const std::string& name, std::shared_ptr<const SpringFunction> function) {
  const std::string where = "spring law `" + name + "`";
  if (!function) return Error{where, "has no function", "give one"};
  if (const char* fault = fault_of(*function)) return Error{where, std::string(fault), "see pliant/surface_law.h"};
  return added<SpringRow, std::size(kSpringRows), SpringLaw>(kSpringRows, springs(), name, std::move(function));
}

Result<Shape> register_shape(const std::string& name, std::shared_ptr<const ShapeFunction> function) {
  const std::string where = "shape `" + name + "`";
  if (!function) return Error{where, "has no function", "give one"};
  if (const char* fault = fault_of(*function)) return Error{where, std::string(fault), "see pliant/surface_law.h"};
  return added<ShapeRow, std::size(kShapeRows), Shape>(kShapeRows, shapes(), name, std::move(function));
}

Result<SolverKind> register_solver(const std::string& name, SolverFactory factory) {
  if (!factory) return Error{"linear solver `" + name + "`", "has no factory", "give a function that makes one"};
  return added<SolverRow, std::size(kSolverRows), SolverKind>(kSolverRows, solvers(), name, std::move(factory));
}

}  // namespace pliant
