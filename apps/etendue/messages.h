// What the program says on stderr.
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace etendue::app {

/// As fmt::print to stderr, but without an error where that takes no text: who reads it may have gone, and
/// what was computed is saved all the same.
template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

/// A share as "0.32 %"; of large ones whole numbers.
inline std::string percent_text(double share) {
  const double value = 100 * share;
  return value < 9.95 ? fmt::format("{:.2g} %", value) : fmt::format("{:.0f} %", value);
}

}  // namespace etendue::app
