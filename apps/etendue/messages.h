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

}  // namespace etendue::app
