#include "base/temporary_file.h"

#include "base/error.h"

#include <atomic>
#include <cerrno>
#include <fmt/format.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace etendue {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw InputError(
      fmt::format("{}: cannot write: {}", file.string(), std::generic_category().message(error)));
}

/// What a file's name stands for where that is a symbolic link, be it there or not; else the name.
std::filesystem::path behind_links(const std::filesystem::path& stated) {
  constexpr int most_links = 40;  // As Linux has it: a longer chain is taken for a circle.
  std::filesystem::path file = stated;
  std::error_code error;
  for (int k = 0; std::filesystem::is_symlink(file, error); ++k) {
    if (k == most_links) fail(stated, ELOOP);
    file = file.parent_path() / std::filesystem::read_symlink(file, error);
    if (error) fail(stated, error.value());
  }
  return file;
}

/// A pipe, a terminal, /dev/null: there, but nothing that a file could take the place of.
bool is_device(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

/// Permissions and, as far as we may, owner of the file that is there.
void take_over_mode(std::FILE* stream, const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return;
  // The owner first: a change of owner clears bits of the mode.
  const bool is_owner_kept = fchown(fileno(stream), status.st_uid, status.st_gid) == 0;
  // Of another group, what its group may do is not for ours.
  if (fchmod(fileno(stream), status.st_mode & (is_owner_kept ? 0777 : 0707)) != 0 || !is_owner_kept)
    errno = 0;
}

}  // namespace

void check_destination(const std::filesystem::path& stated) {
  std::error_code error;
  if (std::filesystem::is_directory(stated, error))
    throw InputError(fmt::format("{}: is a folder; give the name of a file", stated.string()));
  if (is_device(stated)) return;
  const std::filesystem::path file = behind_links(stated);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(fmt::format("{}: the folder {} does not exist; make it first: mkdir -p {}",
                                 stated.string(), folder.string(), folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(
        fmt::format("{}: no permission to write in the folder {}", stated.string(), folder.string()));
}

TemporaryFile::TemporaryFile(const std::filesystem::path& destination)
    : stated_(destination), destination_(behind_links(destination)), path_(destination_) {
  static std::atomic<unsigned> serial{0};
  if (is_device(destination)) {
    path_.clear();
    stream_ = std::fopen(destination.c_str(), "wbe");
  } else {
    path_.replace_filename(fmt::format(".{}.{}-{}", destination_.filename().string(), getpid(), serial++));
    stream_ = std::fopen(path_.c_str(), "wbe");
  }
  if (!stream_) fail(stated_, errno);
  if (!path_.empty()) take_over_mode(stream_, destination_);
}

TemporaryFile::~TemporaryFile() {
  if (stream_) std::fclose(stream_);
  std::error_code ignored;  // After a commit there is nothing to remove.
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

void TemporaryFile::write(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, stream_) != size) fail(stated_, errno);
}

void TemporaryFile::fail_to_write(std::string_view reason) {
  if (errno != 0) fail(stated_, errno);
  throw InputError(fmt::format("{}: cannot write: {}", stated_.string(), reason));
}

void TemporaryFile::commit() {
  errno = 0;
  const bool failed_before = std::ferror(stream_);
  const bool failed = std::fclose(std::exchange(stream_, nullptr)) != 0;
  if (failed_before || failed) fail(stated_, errno != 0 ? errno : EIO);
  if (path_.empty()) return;
  std::error_code error;
  std::filesystem::rename(path_, destination_, error);
  if (error) fail(stated_, error.value());
}

}  // namespace etendue
