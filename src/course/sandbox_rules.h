// What the kernel is asked to hold a sandboxed process to: Landlock for files, seccomp for all else.
#pragma once

#include "course/sandbox.h"

#include <linux/filter.h>
#include <string>
#include <vector>

namespace etendue {

/// Made before the process is, which then has only to take them on.
class SandboxRules {
 public:
  explicit SandboxRules(const SandboxLimits& limits);
  ~SandboxRules();
  SandboxRules(const SandboxRules&) = delete;
  SandboxRules& operator=(const SandboxRules&) = delete;

  /// In the new process, for it and for all that it becomes. Calls only what is safe after a fork.
  /// \return whether it is held to all of them
  bool take_on() const;

  /// Rules that this kernel does not know.
  const std::vector<std::string>& not_held() const { return not_held_; }

 private:
  void make_file_rules(const SandboxLimits& limits);

  SandboxLimits limits_;
  int files_ = -1;  ///< Landlock's rules; -1: there are none.
  std::vector<std::string> not_held_;
};

}  // namespace etendue
