#include "film/temporary_file.h"

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
