#include "folder_watch.h"

#include "base/error.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <sys/inotify.h>
#include <unistd.h>

namespace etendue::app {

FolderWatch::FolderWatch(const std::filesystem::path& folder)
    : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  // Editors write the file itself, or another that they then give its name.
  if (events_ < 0 || inotify_add_watch(events_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO) < 0)
    throw InputError(fmt::format("cannot watch {}: {}", folder.string(), std::strerror(errno)));
}

FolderWatch::~FolderWatch() { close(events_); }

bool FolderWatch::has_change() {
  alignas(inotify_event) std::array<char, 1 << 14> buffer;
  for (ssize_t count; (count = read(events_, buffer.data(), buffer.size())) > 0;)
    for (ssize_t at = 0; at < count;) {
      const auto& event = reinterpret_cast<const inotify_event&>(buffer[std::size_t(at)]);
      const std::filesystem::path file = event.len > 0 ? event.name : "";
      has_change_ = has_change_ || file.extension() == ".cpp" || file.extension() == ".h";
      at += ssize_t(sizeof(inotify_event) + event.len);
    }
  return has_change_;
}

}  // namespace etendue::app
