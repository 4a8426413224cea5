// How many threads the process may use.
#pragma once

#include <memory>

namespace etendue {

/// While it lives, loading, building and rendering together use at most this many threads.
class ThreadLimit {
 public:
  /// \param threads 0: all that the process may run on
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace etendue
