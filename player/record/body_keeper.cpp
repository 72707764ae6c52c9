#include "player/record/body_keeper.h"

#include <fmt/format.h>

#include <iterator>

#include "player/record/csv.h"

namespace pliant {

Result<BodyKeeper> BodyKeeper::create(const World& world, BodyJournal& journal, const std::filesystem::path& csv) {
  BodyKeeper keeper(journal);
  keeper.path_ = csv;
  keeper.csv_.open(csv, std::ios::binary);
  keeper.csv_ << "step,time_s,body,x,y,z,qw,qx,qy,qz\n";
  if (!keeper.csv_) return Error{csv.string(), "cannot be written; check the space left"};
  for (const Entity body : journal.bodies()) {
    const Name* name = world.registry.find<Name>(body);
    keeper.names_.push_back(csv_text(name ? name->value : std::string()));
  }
  return keeper;
}

void BodyKeeper::keep() {
  rows_.clear();
  journal_->drain(rows_);
  for (const BodyRow& row : rows_) {
    line_.clear();
    fmt::format_to(std::back_inserter(line_), "{},{:.9g},{}", row.step, row.time, names_[row.body]);
    put(line_, row.position);
    put(line_, row.rotation);
    line_ += '\n';
    csv_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
  }
}

Status BodyKeeper::finish() {
  csv_.close();
  if (!csv_) return Error{path_.string(), "cannot be written to its end; free some space"};
  return Done{};
}

}  // namespace pliant
