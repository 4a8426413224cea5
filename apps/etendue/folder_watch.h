// Whether files of a folder have been saved.
#pragma once

#include <filesystem>

namespace etendue::app {

/// Of the folder itself, not of those in it.
class FolderWatch {
 public:
  /// Throws InputError where the system does not tell.
  explicit FolderWatch(const std::filesystem::path& folder);
  ~FolderWatch();
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  /// A C++ file has been saved since this was last forgotten.
  bool has_change();
  void forget_change() { has_change_ = false; }

 private:
  int events_;
  bool has_change_ = false;
};

}  // namespace etendue::app
