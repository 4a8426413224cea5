#include "progress.h"

#include "messages.h"

#include <algorithm>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace etendue::app {

namespace {

/// Of the terminal, in characters; 80 where it does not say.
int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::string what, bool is_quiet)
    : what_(std::move(what)),
      is_quiet_(is_quiet),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (has_bar_) app::say("\n");
}

void Progress::update(double fraction) {
  if (is_quiet_) return;
  const Clock::time_point now = Clock::now();
  const auto interval = is_terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(1000);
  const bool is_last = fraction >= 1;
  if (now - last_ < interval && !(is_last && has_bar_)) return;
  last_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const std::string left =
      fraction > 0 ? duration_text(elapsed_s * (1 - fraction) / fraction) + " left" : std::string("starting");
  if (is_terminal_) {
    const std::string end =
        fmt::format("{:3.0f} % {}", 100 * fraction, is_last ? duration_text(elapsed_s) : left);
    // A line that is full would wrap, and a carriage return then goes back to its last part only.
    const int room = terminal_width() - 1;
    const int width = std::min(40, room - int(what_.size() + end.size()) - 4);
    std::string line = end;
    if (width >= 4) {
      const int full = std::clamp(int(fraction * width), 0, width);
      line = fmt::format("{} [{:#<{}}{: <{}}] {}", what_, "", full, "", width - full, end);
    }
    app::say("\r{}\x1b[K", line.substr(0, std::size_t(std::max(room, 0))));
    has_bar_ = true;
  } else {
    app::say("{}: {:.0f} %, {}\n", what_, 100 * fraction, left);
  }
}

void Progress::say(const std::string& line) {
  if (!is_quiet_) app::say("{}{}\n", has_bar_ ? "\r\x1b[K" : "", line);
}

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = long(seconds + 0.5);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace etendue::app
