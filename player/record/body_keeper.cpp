#include "player/record/body_keeper.h"

#include <fmt/format.h>

#include <iterator>

#include "lab/files/csv.h"

namespace pliant {

Result<BodyKeeper> BodyKeeper::create(const World& world, BodyJournal& journal, const std::filesystem::path& csv) {
  BodyKeeper keeper(journal);
  auto file = GrowingFile::create(csv);
  if (!file) return file.error();
  keeper.csv_.emplace(std::move(file).value());
  keeper.csv_->add("step,time_s,body,x,y,z,qw,qx,qy,qz\n");
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
    csv_->add(line_);
  }
}

Status BodyKeeper::finish() {
  return csv_->close();
}

}  // namespace pliant
