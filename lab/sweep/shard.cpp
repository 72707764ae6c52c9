#include "lab/sweep/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace pliant {
namespace {

constexpr std::size_t kMostShards = 1000000;
constexpr const char* kSay = "; say it with --shard I/N";

std::optional<std::size_t> whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value > (1ull << 40)) return {};
  return value;
}

// Number (from 0) and count from a pair of environment variables.
struct ShardPlace {
  std::size_t number = 0, count = 1;
  std::string from;
};

using Variable = std::function<const char*(const char*)>;

// A batch system may set them to the empty string.
std::string read(const Variable& variable, const std::string& name) {
  const char* text = variable(name.c_str());
  return text ? text : "";
}

Result<ShardPlace> in_array(const Variable& variable) {
  const std::string id = "SLURM_ARRAY_TASK_ID", text = read(variable, id);
  if (text.empty()) return ShardPlace{};
  const auto number = whole(text), count = whole(read(variable, "SLURM_ARRAY_TASK_COUNT")),
             first = whole(read(variable, "SLURM_ARRAY_TASK_MIN"));
  const std::string step_text = read(variable, "SLURM_ARRAY_TASK_STEP");
  const std::size_t step = std::max<std::size_t>(whole(step_text).value_or(1), 1);
  if (!number || !count || !first || *count == 0)
    return Error{id, "is '" + text + "', and SLURM_ARRAY_TASK_COUNT and _MIN do not say of how many" + kSay};
  if (*number < *first || (*number - *first) % step != 0 || (*number - *first) / step >= *count)
    return Error{
        id, fmt::format("is {}, which is none of {} tasks from {} on, {} apart{}", text, *count, *first, step, kSay)};
  return ShardPlace{(*number - *first) / step, *count, id + " and _COUNT"};
}

Result<ShardPlace> rank_of(const Variable& variable, const char* rank_name, const char* size_name) {
  const std::string text = read(variable, rank_name), size_text = read(variable, size_name);
  const auto rank = whole(text), size = whole(size_text);
  if (!rank || !size || *rank >= *size)
    return Error{rank_name,
                 "is '" + text + "' and " + size_name + " '" + size_text + "', which is no rank of so many" + kSay};
  return ShardPlace{*rank, *size, std::string(rank_name) + " and " + size_name};
}

// True in a task started by srun. The batch script itself (one, whatever --ntasks is) also has SLURM_PROCID 0 and
// SLURM_NTASKS, but no step. An interactive shell has no step either, or a step id from the reserved end of the range.
bool in_step(const Variable& variable) {
  constexpr std::size_t kSpecial = 0xfffffff0;
  const auto step = whole(read(variable, "SLURM_STEP_ID"));
  return step && *step < kSpecial && !read(variable, "SLURM_PROCID").empty();
}

// MPI's variables take precedence: mpirun may run within a step and start several processes in each task.
Result<ShardPlace> in_ranks(const Variable& variable) {
  for (const auto& [rank, size] : {std::pair("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), {"PMI_RANK", "PMI_SIZE"}})
    if (!read(variable, rank).empty()) return rank_of(variable, rank, size);
  // SLURM_NTASKS may be that of the whole job, of which the step is a part.
  if (in_step(variable))
    return rank_of(variable, "SLURM_PROCID",
                   read(variable, "SLURM_STEP_NUM_TASKS").empty() ? "SLURM_NTASKS" : "SLURM_STEP_NUM_TASKS");
  if (const std::string rank = read(variable, "PMIX_RANK"); !rank.empty())
    return Error{"PMIX_RANK", "is '" + rank + "', and no variable says of how many" + kSay};
  return ShardPlace{};
}

}  // namespace

std::string Shard::file() const {
  return fmt::format("runs-{}-of-{}.jsonl", number, count);
}

Result<Shard> choose_shard(const std::string& argument, const Variable& variable) {
  Shard shard;
  if (!argument.empty()) {
    const std::size_t slash = argument.find('/');
    const auto number = whole(argument.substr(0, slash));
    const auto count = slash == std::string::npos ? std::nullopt : whole(argument.substr(slash + 1));
    if (!number || !count || *number < 1 || *number > *count || *count > kMostShards)
      return Error{"--shard", "must be I/N with 1 <= I <= N, such as 2/4; got '" + argument + "'"};
    shard.number = *number;
    shard.count = *count;
    return shard;
  }
  const auto array = in_array(variable), mpi = in_ranks(variable);
  if (!array) return array.error();
  if (!mpi) return mpi.error();
  if (array->count > kMostShards || mpi->count > kMostShards / array->count)
    return Error{"shard", fmt::format("{} tasks of {} ranks are too many{}", array->count, mpi->count, kSay)};
  shard.count = array->count * mpi->count;
  shard.number = array->number * mpi->count + mpi->number + 1;
  shard.from = array->from + (array->from.empty() || mpi->from.empty() ? "" : ", ") + mpi->from;
  return shard;
}

}  // namespace pliant
