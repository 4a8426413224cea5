// A file that appears under its name only when it is complete.
#pragma once

#include <cstdio>
#include <filesystem>

namespace etendue {

/// Throws InputError unless a TemporaryFile can stand beside `file` and be renamed to it, as far as can be
/// told without trying: asked before long work, not after.
void check_destination(const std::filesystem::path& file);

/// Open for writing in the folder of `destination` under a name of its own; renamed to `destination` by
/// commit, removed if that is not reached. All members but the destructor throw InputError with the path and
/// the reason.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& destination);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// For writing; what fails is found by commit at the latest.
  std::FILE* stream() { return stream_; }

  /// Completes the file: a full disk is an error here, not a file cut short.
  void commit();

 private:
  std::filesystem::path destination_, path_;
  std::FILE* stream_;
};

}  // namespace etendue
