#include "player/sweep/shard.h"

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

// Two variables that belong together: this one's number, from 0, and how many there are.
struct ShardPlace {
  std::size_t number = 0, count = 1;
  std::string from;
};

using Variable = std::function<const char*(const char*)>;

// A batch system may set them to nothing.
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

Result<ShardPlace> in_mpi(const Variable& variable) {
  for (const auto& [rank_name, size_name, from] :
       {std::tuple("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK and _SIZE"),
        std::tuple("PMI_RANK", "PMI_SIZE", "PMI_RANK and PMI_SIZE")}) {
    const std::string text = read(variable, rank_name);
    if (text.empty()) continue;
    const auto rank = whole(text), size = whole(read(variable, size_name));
    if (!rank || !size || *rank >= *size)
      return Error{rank_name, "is '" + text + "' and " + size_name + " '" + read(variable, size_name) +
                                  "', which is no rank of so many" + kSay};
    return ShardPlace{*rank, *size, from};
  }
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
  const auto array = in_array(variable), mpi = in_mpi(variable);
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
