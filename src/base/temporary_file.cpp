#include "base/temporary_file.h"

#include "base/error.h"

#include <atomic>
#include <cerrno>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace etendue {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw InputError(
      fmt::format("{}: cannot write: {}", file.string(), std::generic_category().message(error)));
}

}  // namespace

void check_destination(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw InputError(fmt::format("{}: is a folder; give the name of a file", file.string()));
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(fmt::format("{}: the folder {} does not exist; make it first: mkdir -p {}",
                                 file.string(), folder.string(), folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(
        fmt::format("{}: no permission to write in the folder {}", file.string(), folder.string()));
}

TemporaryFile::TemporaryFile(const std::filesystem::path& destination) : destination_(destination) {
  static std::atomic<unsigned> serial{0};
  path_ = destination_;
  path_.replace_filename(fmt::format(".{}.{}-{}", destination_.filename().string(), getpid(), serial++));
  stream_ = std::fopen(path_.c_str(), "wbe");
  if (!stream_) fail(destination_, errno);
}

TemporaryFile::~TemporaryFile() {
  if (stream_) std::fclose(stream_);
  std::error_code ignored;  // After a commit there is nothing to remove.
  std::filesystem::remove(path_, ignored);
}

void TemporaryFile::commit() {
  errno = 0;
  const bool failed_before = std::ferror(stream_);
  const bool failed = std::fclose(std::exchange(stream_, nullptr)) != 0;
  if (failed_before || failed) fail(destination_, errno != 0 ? errno : EIO);
  std::error_code error;
  std::filesystem::rename(path_, destination_, error);
  if (error) fail(destination_, error.value());
}

}  // namespace etendue
