// Runs the etendue program as a user does, and keeps what it said.
#pragma once

#include "support/temporary_folder.h"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace etendue::test {

/// How a run ended: `exit_code` is minus the signal's number where one ended it.
struct ProgramResult {
  int exit_code;
  std::string out, err;
  double seconds;
  long peak_memory_kib;  ///< Resident.
};

/// A run of etendue in the folder `where`, without a terminal.
class Program {
 public:
  /// \param err_descriptor where stderr goes, if it is not to be kept
  Program(const std::vector<std::string>& arguments, const std::filesystem::path& where,
          int err_descriptor = -1)
      : start_(std::chrono::steady_clock::now()) {
    const std::string out = (streams_.path() / "out").string(), err = (streams_.path() / "err").string();
    const std::string folder = where.string();
    std::vector<std::string> words{ETENDUE_BINARY_DIR "/etendue"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    process_ = fork();
    if (process_ < 0) throw std::runtime_error("cannot fork");
    if (process_ == 0) {
      dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
      dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
      dup2(err_descriptor >= 0 ? err_descriptor : open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
      if (chdir(folder.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Program() {
    if (process_ > 0) wait(0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Until `is_so()`, or a minute has passed.
  template <class Condition>
  void wait_until(Condition&& is_so) const {
    while (!is_so() && seconds() < 60) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  void send(int signal) const { kill(process_, signal); }
  std::string out_so_far() const { return read_file(streams_.path() / "out"); }
  std::string err_so_far() const { return read_file(streams_.path() / "err"); }

  /// Kills it, for an exit code of -SIGKILL, where it is not done in time.
  ProgramResult wait(double timeout_s = 120) {
    int status = 0;
    rusage usage{};
    while (wait4(process_, &status, WNOHANG, &usage) == 0) {
      if (seconds() > timeout_s) send(SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    process_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(streams_.path() / "out"),
            read_file(streams_.path() / "err"), seconds(), usage.ru_maxrss};
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  TemporaryFolder streams_;
  std::chrono::steady_clock::time_point start_;
  pid_t process_ = 0;
};

inline ProgramResult run_program(const std::vector<std::string>& arguments,
                                 const std::filesystem::path& where, double timeout_s = 120) {
  return Program(arguments, where).wait(timeout_s);
}

}  // namespace etendue::test
