// The entries of a folder as a list, one of them selected.
#pragma once

#include <memory>
#include <string>

#include "editor/panels/folder_listing.h"

namespace pliant {

class FolderList {
 public:
  // Null: the folder is being read.
  void show(std::shared_ptr<const FolderListing> listing) { listing_ = std::move(listing); }
  void select_none() {
    selected_.clear();
    on_folder_ = false;
  }
  const std::string& selected() const { return selected_; }  // "": none
  bool on_folder() const { return on_folder_; }              // the selected entry was reached by keys and is a folder

  // Arrow keys move the selection, letters search by name. The entry that they select, or null.
  const FolderEntry* take_keys();
  // The entry pressed in this frame, or null; a file is selected then. `twice`: by a double click.
  const FolderEntry* draw(bool& twice);

 private:
  std::shared_ptr<const FolderListing> listing_;
  std::string selected_;
  bool on_folder_ = false;
};

}  // namespace pliant
