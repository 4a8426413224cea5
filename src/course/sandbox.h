// Runs a program that may do anything: in a process of its own, with limits, and without harm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

struct SandboxLimits {
  double seconds = 60;                               ///< By the clock; and as much processor time a thread.
  std::size_t memory_bytes = std::size_t{4} << 30;   ///< Addresses it may ask for; 0: as many as it likes.
  std::size_t file_bytes = std::size_t{256} << 20;   ///< Of each file that it writes.
  std::size_t output_bytes = std::size_t{64} << 10;  ///< Of what it prints; the rest is counted and dropped.
  std::vector<std::filesystem::path> writable{};     ///< Folders that it may write to; nothing else.
  std::size_t written_bytes = std::size_t{1} << 30;  ///< That may come to stand in these, about.
  std::filesystem::path folder{};                    ///< That it runs in; empty: that of this program.
  bool may_start_programs = false;                   ///< As compilers must.
};

struct SandboxResult {
  int exit_code = 0;  ///< Where it ended by itself.
  int signal = 0;     ///< That ended it; 0: none did.
  bool is_out_of_time = false;
  bool is_cut_short = false;    ///< `must_end` asked for it.
  bool is_out_of_room = false;  ///< It wrote more than it may.
  std::string output;           ///< Standard output and error as they came, the first bytes of it.
  std::uint64_t printed_bytes = 0;
  double seconds = 0;
  std::vector<std::string> not_held{};  ///< Limits that this system's kernel cannot hold it to.

  bool is_done() const { return exit_code == 0 && signal == 0 && !is_ended(); }
  /// Before it was done, from outside.
  bool is_ended() const { return is_out_of_time || is_cut_short || is_out_of_room; }
};

/// Runs `words` (the program by its path, then its arguments) to its end. It has no network, may signal no
/// other process, and starts none unless it may. Throws InputError where it cannot be started.
/// \param must_end asked ten times a second, where it is given
SandboxResult run_in_sandbox(const std::vector<std::string>& words, const SandboxLimits& limits,
                             const std::function<bool()>& must_end = {});

/// Addresses (bytes) for a render with a thread for each processor, and for what a student's code may ask
/// for.
std::size_t memory_for_rendering();

/// Why it ended as it did, for the person who wrote the code; empty where it is done, or says so by itself.
std::string explanation(const SandboxResult& result, const SandboxLimits& limits);

}  // namespace etendue
