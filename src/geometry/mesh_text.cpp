#include "geometry/mesh_text.h"

#include "base/number_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue {
namespace {

struct Parsed {
  double value;
  std::errc error;
  bool is_whole_token;
};

Parsed parse(std::string_view token) {
  Parsed parsed{0, std::errc::invalid_argument, false};
  // from_chars takes a minus sign only.
  const bool has_plus = token.starts_with('+');
  if (has_plus) token.remove_prefix(1);
  if (has_plus && token.starts_with('-')) return parsed;
  const char* end = token.data() + token.size();
  const auto [stop, error] = number_from_chars(token.data(), end, parsed.value);
  parsed.error = error;
  parsed.is_whole_token = stop == end;
  return parsed;
}

}  // namespace

Location whole_file(const SourceFile& source) {
  return {std::make_shared<SourceFile>(SourceFile{source.path, {}})};
}

std::optional<double> finite_number(std::string_view token) {
  const Parsed parsed = parse(token);
  if (parsed.error != std::errc() || !parsed.is_whole_token || !std::isfinite(parsed.value))
    return std::nullopt;
  return parsed.value;
}

NumberProblem number_problem(std::string_view token) {
  const Parsed parsed = parse(token);
  if (parsed.error == std::errc::result_out_of_range)
    return {fmt::format("{} is out of range", quoted(token)), "expected a number that fits a float"};
  if (parsed.error == std::errc() && !std::isfinite(parsed.value))
    return {fmt::format("{} is not a finite number", quoted(token)),
            "the program that wrote this file made an error; export the mesh anew, or repair the vertex by "
            "hand"};
  return {fmt::format("{} is not a number", quoted(token)), "expected something like -1.5 or 2e-3"};
}

std::string quoted(std::string_view token) {
  constexpr std::size_t most = 40;
  std::string shown(token.substr(0, most));
  for (char& c : shown)
    if (c < 0x20 || c > 0x7e) c = '?';
  return fmt::format("'{}{}'", shown, token.size() > most ? "..." : "");
}

Vec3f unit_or_zero(const Vec3<double>& n) {
  if (!std::isfinite(n.x) || !std::isfinite(n.y) || !std::isfinite(n.z)) return {0, 0, 0};
  const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  if (largest == 0) return {0, 0, 0};
  const auto unit = normalize(n / largest);
  return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
}

}  // namespace etendue
