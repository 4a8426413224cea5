// A file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace etendue {

/// Throws InputError unless a TemporaryFile can stand beside `file` and be renamed to it, as far as can be
/// told without trying: asked before long work, not after.
void check_destination(const std::filesystem::path& file);

/// Open for writing in the folder of `destination` under a name of its own; renamed to `destination` by
/// commit, removed if that is not reached. Where `destination` is a symbolic link, this is what it points to,
/// and the link stays; where there is such a file, its permissions are kept, and its owner if we may. A
/// device or a pipe is written to as it is. All members but the destructor throw InputError with the path and
/// the reason.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& destination);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(const void* data, std::size_t size);

  /// For libraries that write by themselves; what fails is found by commit at the latest.
  std::FILE* stream() { return stream_; }

  /// Throws for a library's write that has failed: what the system said (errno), else the library's `reason`.
  [[noreturn]] void fail_to_write(std::string_view reason);

  /// Completes the file: a full disk is an error here, not a file cut short.
  void commit();

 private:
  std::filesystem::path stated_, destination_;
  std::filesystem::path path_;  ///< Of the temporary file; empty where the destination itself is open.
  std::FILE* stream_;
};

}  // namespace etendue
