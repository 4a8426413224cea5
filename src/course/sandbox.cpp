#include "course/sandbox.h"

#include "base/error.h"
#include "course/sandbox_rules.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue {

namespace {

constexpr int not_started = 126;  ///< Exit code of a process that could not become the program.

/// Bytes in the files below these folders; very many where there are too many files to count, or some that
/// cannot be looked at.
std::uintmax_t bytes_in(const std::vector<std::filesystem::path>& folders) {
  constexpr std::uintmax_t too_many = std::uintmax_t{1} << 62;
  constexpr int most_files = 20000;
  std::uintmax_t bytes = 0;
  int files = 0;
  for (const std::filesystem::path& folder : folders) {
    std::error_code gone;  // Files come and go while they are looked at.
    for (std::filesystem::recursive_directory_iterator file(folder, gone), end; !gone && file != end;
         file.increment(gone)) {
      if (++files > most_files) return too_many;
      std::error_code unknown_size;
      if (!file->is_regular_file(unknown_size)) continue;
      const std::uintmax_t size = file->file_size(unknown_size);
      if (!unknown_size) bytes += size;
    }
    if (gone && gone != std::errc::no_such_file_or_directory) return too_many;
  }
  return bytes;
}

/// In the new process. Does not come back.
[[noreturn]] void become(char* const* words, const char* folder, int output, const SandboxRules& rules) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would end it
  dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  if (chdir(folder) == 0 && rules.take_on()) execv(words[0], words);
  for (;;) syscall(SYS_exit_group, not_started);
}

class Process {
 public:
  Process(const std::vector<std::string>& words, const SandboxLimits& limits, const SandboxRules& rules)
      : limits_(limits), bytes_before_(bytes_in(limits.writable)), start_(std::chrono::steady_clock::now()) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw InputError(fmt::format("cannot start {}: {}", words[0], std::strerror(errno)));
    const std::string folder = limits.folder.empty() ? "." : limits.folder.string();
    process_ = fork();
    if (process_ == 0) become(arguments.data(), folder.c_str(), ends[1], rules);
    close(ends[1]);
    output_ = ends[0];
    if (process_ < 0) {
      close(output_);
      throw InputError(fmt::format("cannot start {}: {}", words[0], std::strerror(errno)));
    }
    setpgid(process_, process_);
  }
  ~Process() {
    end();
    close(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Takes in what it prints until it closes its output, its time is up, or it must end.
  void listen(SandboxResult& result, const std::function<bool()>& must_end) {
    std::array<char, 1 << 16> buffer;
    for (;;) {
      const double left = limits_.seconds - seconds();
      if (left <= 0) {
        result.is_out_of_time = true;
        return;
      }
      if (must_end && must_end()) {
        result.is_cut_short = true;
        return;
      }
      if (is_room_used_up()) {
        result.is_out_of_room = true;
        return;
      }
      pollfd ready{output_, POLLIN, 0};
      if (poll(&ready, 1, int(1000 * std::min(left, 0.1)) + 1) <= 0) {
        if (has_ended()) return;
        continue;
      }
      const ssize_t count = read(output_, buffer.data(), buffer.size());
      if (count <= 0) return;
      result.printed_bytes += std::uint64_t(count);
      const std::size_t room = limits_.output_bytes - std::min(limits_.output_bytes, result.output.size());
      result.output.append(buffer.data(), std::min(std::size_t(count), room));
    }
  }

  /// Waits for what has closed its output, within the time; then ends it and all that it started.
  void finish(SandboxResult& result) {
    while (!result.is_ended() && !has_ended()) {
      usleep(1000);
      result.is_out_of_time = seconds() > limits_.seconds;
      result.is_out_of_room = is_room_used_up();
    }
    end();
    result.seconds = seconds();
    if (result.is_ended()) return;
    if (WIFSIGNALED(status_)) result.signal = WTERMSIG(status_);
    if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
    result.is_out_of_time = result.signal == SIGXCPU;
  }

 private:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Looked at ten times a second at most.
  bool is_room_used_up() {
    if (seconds() < next_look_) return false;
    next_look_ = seconds() + 0.1;
    return bytes_in(limits_.writable) > bytes_before_ + limits_.written_bytes;
  }
  bool has_ended() {
    if (!is_waited_for_) is_waited_for_ = waitpid(process_, &status_, WNOHANG) == process_;
    return is_waited_for_;
  }
  void end() {
    kill(-process_, SIGKILL);
    if (is_waited_for_) return;
    waitpid(process_, &status_, 0);
    is_waited_for_ = true;
  }

  const SandboxLimits& limits_;
  std::uintmax_t bytes_before_;
  double next_look_ = 0;
  std::chrono::steady_clock::time_point start_;
  pid_t process_ = -1;
  int output_ = -1, status_ = 0;
  bool is_waited_for_ = false;
};

std::string what_signal_means(int signal) {
  switch (signal) {
    case SIGSEGV:
    case SIGBUS:
      return "it crashed: it read or wrote where nothing is, as by a null pointer, an index past the end of "
             "an "
             "array, or a function that calls itself for ever; --sanitize tells the line";
    case SIGFPE:
      return "it crashed: a division of whole numbers by zero";
    case SIGABRT:
      return "it gave up (abort): an assertion does not hold, or its memory is in disorder (written past the "
             "end of "
             "an array, freed twice, shared by threads); --sanitize may tell the line";
    case SIGILL:
    case SIGTRAP:
      return "it crashed: it ran into a place that no program should reach, as the end of a function that "
             "should return something";
    case SIGXFSZ:
      return "it wrote a file that is too large";
    case SIGKILL:
      return "the system ended it, mostly for want of memory";
    case SIGSYS:
      return "it was ended: it asked the system for what it may not have";
    default:
      return fmt::format("it was ended by signal {} ({})", signal, strsignal(signal));
  }
}

}  // namespace

SandboxResult run_in_sandbox(const std::vector<std::string>& words, const SandboxLimits& limits,
                             const std::function<bool()>& must_end) {
  const SandboxRules rules(limits);
  SandboxResult result;
  result.not_held = rules.not_held();
  Process process(words, limits, rules);
  process.listen(result, must_end);
  process.finish(result);
  if (result.exit_code == not_started && result.printed_bytes == 0)
    throw InputError(fmt::format("cannot run {} within limits", words[0]));
  return result;
}

std::size_t memory_for_rendering() {
#ifdef __SANITIZE_ADDRESS__  // which takes terabytes of addresses for itself
  return 0;
#endif
  // Each thread has a stack, and addresses for an arena of its own, few of which are ever used.
  constexpr std::size_t program = std::size_t{4} << 30, thread = std::size_t{160} << 20;
  return program + thread * std::size_t(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
}

std::string explanation(const SandboxResult& result, const SandboxLimits& limits) {
  std::string text = result.signal != 0 ? what_signal_means(result.signal) : std::string();
  if (result.is_out_of_time)
    text = fmt::format(
        "it was not done after {:.0f} s and was ended: a loop that does not end, or far too much work",
        limits.seconds);
  if (result.is_out_of_room)
    text = fmt::format("it wrote files of more than the {:.1f} GB that it may fill, and was ended",
                       1e-9 * double(limits.written_bytes));
  if (result.output.find("bad_alloc") != std::string::npos)
    text = fmt::format("it asked for more memory than the {:.1f} GiB that it may have",
                       double(limits.memory_bytes) / double(1 << 30));
  if (result.printed_bytes > limits.output_bytes)
    text += fmt::format("{}it printed {:.1f} MB, of which the first {:.0f} kB are shown",
                        text.empty() ? "" : "; ", 1e-6 * double(result.printed_bytes),
                        1e-3 * double(limits.output_bytes));
  return text;
}

}  // namespace etendue
