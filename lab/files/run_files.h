// Which files in a folder are runs': by the list that each leaves there, by their names, and while one is under way.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

inline constexpr const char* kRunList = ".pliant-run";

// What the list in `folder` names: plain files there that a run wrote. Empty without one.
std::set<std::string> listed_files(const std::filesystem::path& folder);
// The list's text.
std::string list_text(const std::vector<std::string>& names);

// Files with the names that results have (report.json, frame-0000.png, ...), whoever wrote them.
std::vector<std::string> result_files(const std::filesystem::path& folder);

// Opens and locks the list of a run that begins to stage in `staging`: as long as the process lives. -1: it cannot be
// written, errno says why.
int begin_list(const std::filesystem::path& staging);
// Removes what killed runs left staged in `folder`. True: another run is writing there.
bool clear_abandoned(const std::filesystem::path& folder);

}  // namespace pliant
