#include "run_options.h"

#include <fmt/format.h>

namespace etendue::app {

Isa RunOptions::isa() const { return isa_name.empty() ? available_isas().back() : isa_from_name(isa_name); }

std::optional<Dialect> RunOptions::dialect() const {
  return dialect_name.empty() ? std::nullopt : std::optional(dialect_from_name(dialect_name));
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("--seed", options.seed, "Another seed: other random numbers")
      ->capture_default_str()
      ->check([](const std::string& text) {  // CLI11 would wrap a negative number around.
        return text.starts_with('-') ? fmt::format("{} is negative; expected a whole number from 0 on", text)
                                     : "";
      });
  command.add_option("--threads", options.threads, "Threads; 0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  command.add_option("--isa", options.isa_name, "Instruction set: scalar, v2, v3 or v4 [the widest here]");
  command.add_option("--dialect", options.dialect_name, "Read files as nori-2012, nori-eth or nori");
}

}  // namespace etendue::app
