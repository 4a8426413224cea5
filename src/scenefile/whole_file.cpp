#include "scenefile/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace etendue {
namespace {

struct File {
  int descriptor;
  ~File() {
    if (descriptor >= 0) close(descriptor);
  }

  /// False where `size` bytes are not there.
  bool read_whole(std::string& text, std::size_t size) const {
    text.resize(size);
    for (std::size_t done = 0; done < size;) {
      const ssize_t count = read(descriptor, text.data() + done, size - done);
      if (count <= 0) return false;
      done += std::size_t(count);
    }
    return true;
  }
};

}  // namespace

std::shared_ptr<const SourceFile> read_whole_file(const std::filesystem::path& file, std::string_view kind) {
  // One look-up of the path and no buffer: a scene may name 200,000 files. A pipe must not be waited for.
  const File opened{open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat status {};
  const bool is_open = opened.descriptor >= 0 && fstat(opened.descriptor, &status) == 0;
  std::error_code error;
  if (!is_open && !std::filesystem::exists(file, error))
    throw InputError(fmt::format("{}: there is no such file", file.string()));
  if (is_open ? !S_ISREG(status.st_mode) : !std::filesystem::is_regular_file(file, error))
    throw InputError(fmt::format("{}: not a regular file; expected {}", file.string(), kind));
  auto source = std::make_shared<SourceFile>();
  source->path = file.string();
  if (!is_open || !opened.read_whole(source->text, std::size_t(status.st_size)))
    throw InputError(fmt::format("{}: cannot be read; is it permitted?", file.string()));
  return source;
}

}  // namespace etendue
