#include "run_options.h"

#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <string_view>

namespace etendue::app {

Isa RunOptions::isa() const { return isa_name.empty() ? available_isas().back() : isa_from_name(isa_name); }

std::optional<Dialect> RunOptions::dialect() const {
  return dialect_name.empty() ? std::nullopt : std::optional(dialect_from_name(dialect_name));
}

std::function<std::string(const std::string&)> whole_number(std::uint64_t most) {
  return [most](const std::string& text) -> std::string {
    const std::string_view sign = text.starts_with('-') ? "-" : "";
    const std::string_view digits = std::string_view(text).substr(sign.size());
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error == std::errc::result_out_of_range || (error == std::errc() && number > most))
      return fmt::format("{} is too large; expected at most {}{}", text, sign, most);
    if (error != std::errc() || end != digits.data() + digits.size())
      return fmt::format("{} is not a whole number", text);
    if (digits.size() > 1 && digits.front() == '0')
      return fmt::format("{} begins with a 0; write {}{}", text, sign, number);
    return "";
  };
}

std::function<std::string(const std::string&)> positive_number() {
  return [](const std::string& text) {
    double number = 0;
    const bool is_positive =
        CLI::detail::lexical_cast(text, number) && number > 0 && number <= std::numeric_limits<double>::max();
    return is_positive ? std::string() : fmt::format("'{}' is not a number above 0", text);
  };
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("--seed", options.seed, "Another seed: other random numbers")
      ->capture_default_str()
      ->check(whole_number(std::numeric_limits<std::uint64_t>::max()))
      ->check([](const std::string& text) {  // CLI11 would wrap a negative number around.
        return text.starts_with('-') ? fmt::format("{} is negative; expected a whole number from 0 on", text)
                                     : "";
      });
  command.add_option("--threads", options.threads, "Threads; 0: all cores")
      ->capture_default_str()
      ->check(whole_number(std::numeric_limits<int>::max()))
      ->check(CLI::Range(0, 4096));
  command.add_option("--isa", options.isa_name, "Instruction set: scalar, v2, v3 or v4 [the widest here]");
  command.add_option("--dialect", options.dialect_name, "Read files as nori-2012, nori-eth or nori");
}

}  // namespace etendue::app
