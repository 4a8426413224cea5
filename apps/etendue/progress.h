// How far a render is: a bar on a terminal, a line a second elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace etendue::app {

class Progress {
 public:
  /// \param is_quiet says nothing at all
  Progress(std::string what, bool is_quiet);
  /// Ends the bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param fraction done, in [0, 1]
  void update(double fraction);
  /// A line of its own.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool is_quiet_, is_terminal_;
  bool has_bar_ = false;
  Clock::time_point start_, last_;
};

/// "4.2 s", "3 min 10 s", "2 h 05 min"
std::string duration_text(double seconds);

}  // namespace etendue::app
