#include "progress.h"

#include "messages.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace etendue::app {

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
    constexpr int width = 40;
    const int full = std::clamp(int(fraction * width), 0, width);
    app::say("\r{} [{:#<{}}{: <{}}] {:3.0f} % {} \x1b[K", what_, "", full, "", width - full, 100 * fraction,
             is_last ? duration_text(elapsed_s) : left);
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
