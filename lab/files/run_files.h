// Finds which files in a folder were written by runs: by the list that each run leaves, by file names, and by the lock
// of a running one.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

inline constexpr const char* kRunList = ".pliant-run";

// Regular files named by the list in `folder`. Empty if there is no list.
std::set<std::string> listed_files(const std::filesystem::path& folder);
// The list's text.
std::string list_text(const std::vector<std::string>& names);

// Files with the names of results (report.json, frame-0000.png, ...), whoever wrote them.
std::vector<std::string> result_files(const std::filesystem::path& folder);

// Opens and locks the list of a run that starts to stage in `staging`; the lock lasts as long as the process. Returns
// -1 and sets errno if the list cannot be written.
int begin_list(const std::filesystem::path& staging);
// Removes what killed runs left staged in `folder`. Returns true if another run is writing there.
bool clear_abandoned(const std::filesystem::path& folder);

}  // namespace pliant
