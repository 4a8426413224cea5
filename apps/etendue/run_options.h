// The options that commands which compute have in common.
#pragma once

#include "render/isa.h"
#include "scenefile/dialect.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace etendue::app {

struct RunOptions {
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0: all cores.
  std::string isa_name, dialect_name;

  Isa isa() const;                         ///< Throws InputError for one that this machine has not.
  std::optional<Dialect> dialect() const;  ///< Throws InputError for an unknown one.
};

/// For CLI11's check(): what is wrong with the text of a whole number whose size is at most `most`; empty
/// where nothing is. CLI11 itself takes 010 for 8, and what is too large for the largest.
std::function<std::string(const std::string&)> whole_number(std::uint64_t most);

/// The same of a finite number above 0.
std::function<std::string(const std::string&)> positive_number();

/// Adds --seed, --threads, --isa and --dialect. `options` must live as long as the command.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace etendue::app
