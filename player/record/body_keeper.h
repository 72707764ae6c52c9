// The keeper of the soft steps' journal: drains the ring and writes bodies.csv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/world.h"
#include "content/files/growing_file.h"
#include "engine/run/body_journal.h"
#include "runtime/result.h"

namespace pliant {

class BodyKeeper {
 public:
  // `csv`: output file. `journal` must outlive it. Names are copied from the world now.
  static Result<BodyKeeper> create(const World& world, BodyJournal& journal, const std::filesystem::path& csv);

  void keep();      // all pending rows
  Status finish();  // closes bodies.csv
  const std::optional<Error>& failure() const { return csv_->failure(); }

 private:
  explicit BodyKeeper(BodyJournal& journal) : journal_(&journal) {}
  BodyJournal* journal_;
  std::optional<GrowingFile> csv_;  // always set
  std::string line_;
  std::vector<BodyRow> rows_;
  std::vector<std::string> names_;  // of the bodies, quoted for CSV
};

}  // namespace pliant
