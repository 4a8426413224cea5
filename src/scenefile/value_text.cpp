#include "scenefile/value_text.h"

#include "base/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>

namespace etendue {
namespace {

constexpr std::string_view xml_white_space = " \t\r\n";

/// The place of `part`, a view into `text`.
Location place_of_part(std::string_view part, std::string_view text, const Location& where) {
  const bool is_verbatim = where.source && where.offset <= where.source->text.size() &&
                           std::string_view(where.source->text).substr(where.offset, text.size()) == text;
  if (!is_verbatim) return where;
  return {where.source, where.offset + static_cast<std::size_t>(part.data() - text.data()),
          std::max<std::size_t>(part.size(), 1)};
}

std::vector<std::string_view> split_values(std::string_view text, const Location& where) {
  std::vector<std::string_view> tokens;
  bool is_number_due = true;  // At the start and behind a comma.
  for (std::size_t at = 0; at < text.size();) {
    if (xml_white_space.find(text[at]) != std::string_view::npos) {
      ++at;
    } else if (text[at] == ',') {
      if (is_number_due)
        throw InputError(place_of_part(text.substr(at, 1), text, where),
                         "a number is missing before this comma");
      is_number_due = true;
      ++at;
    } else {
      const std::size_t end = std::min(text.find_first_of(", \t\r\n", at), text.size());
      tokens.push_back(text.substr(at, end - at));
      is_number_due = false;
      at = end;
    }
  }
  return tokens;
}

/// The whole of `token` as a number of type T. std::from_chars knows no plus sign.
template <class T>
T parse_token(std::string_view token, std::string_view text, const Location& where, std::string_view kind) {
  std::string_view digits = token;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  T number{};
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = [&] {
    if constexpr (std::is_same_v<T, double>)
      return number_from_chars(digits.data(), last, number);
    else
      return std::from_chars(digits.data(), last, number);
  }();
  const bool is_whole = end == last;
  if (error == std::errc::result_out_of_range && is_whole)
    throw InputError(place_of_part(token, text, where),
                     fmt::format("'{}' is out of range for {}", token, kind));
  if (error != std::errc() || !is_whole)
    throw InputError(place_of_part(token, text, where), fmt::format("'{}' is not {}", token, kind));
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(number))
      throw InputError(place_of_part(token, text, where), fmt::format("'{}' is not a finite number", token));
  return number;
}

template <class T>
T parse_single(std::string_view text, const Location& where, std::string_view kind) {
  const std::vector<std::string_view> tokens = split_values(text, where);
  if (tokens.empty()) throw InputError(where, fmt::format("the value is empty; expected {}", kind));
  const T number = parse_token<T>(tokens[0], text, where, kind);
  if (tokens.size() > 1)
    throw InputError(place_of_part(tokens[1], text, where),
                     fmt::format("'{}' is one number too many; expected {}", tokens[1], kind),
                     "decimals take a point: 1.5");
  return number;
}

}  // namespace

bool parse_boolean(std::string_view text, const Location& where) {
  const std::size_t begin = std::min(text.find_first_not_of(xml_white_space), text.size());
  const std::string_view token = text.substr(begin, text.find_last_not_of(xml_white_space) + 1 - begin);
  std::string lower(token);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (lower != "true" && lower != "false")
    throw InputError(place_of_part(token, text, where),
                     fmt::format("'{}' is neither 'true' nor 'false'", token));
  return lower == "true";
}

int parse_integer(std::string_view text, const Location& where) {
  return parse_single<int>(text, where, "an integer");
}

double parse_real(std::string_view text, const Location& where) {
  return parse_single<double>(text, where, "a number");
}

std::vector<double> parse_reals(std::string_view text, const Location& where,
                                std::initializer_list<std::size_t> counts) {
  const std::vector<std::string_view> tokens = split_values(text, where);
  std::vector<double> numbers;
  for (const std::string_view token : tokens)
    numbers.push_back(parse_token<double>(token, text, where, "a number"));
  const bool is_right = counts.size() == 0
                            ? !numbers.empty()
                            : std::find(counts.begin(), counts.end(), numbers.size()) != counts.end();
  if (!is_right) {
    const std::string expected =
        counts.size() == 0 ? "one or more" : fmt::format("{}", fmt::join(counts, " or "));
    const std::size_t most = counts.size() == 0 ? 0 : std::max(counts);
    throw InputError(numbers.size() > most ? place_of_part(tokens[most], text, where) : where,
                     fmt::format("expected {} numbers, found {}", expected, numbers.size()));
  }
  return numbers;
}

namespace {

/// "r, g, b" linear of "#rrggbb"; empty where it is not of this form.
std::string linear_of_hex(std::string_view text) {
  unsigned int value = 0;
  if (text.size() != 7 || text[0] != '#') return {};
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
  if (error != std::errc() || end != text.data() + 7) return {};
  const auto linear = [&](int shift) {  // IEC 61966-2-1
    const double encoded = (value >> shift & 0xff) / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
  };
  return fmt::format("{:.4g}, {:.4g}, {:.4g}", linear(16), linear(8), linear(0));
}

}  // namespace

Colorf parse_color(std::string_view text, const Location& where) {
  if (const std::string linear = linear_of_hex(text); !linear.empty())
    throw InputError(where, fmt::format("'{}' is a colour of sRGB; colours here are linear", text),
                     fmt::format("write value=\"{}\" for it", linear));
  const std::vector<double> numbers = parse_reals(text, where, {1, 3});
  Colorf color{static_cast<float>(numbers.front()), static_cast<float>(numbers[numbers.size() / 2]),
               static_cast<float>(numbers.back())};
  if (!std::isfinite(color.r) || !std::isfinite(color.g) || !std::isfinite(color.b))
    throw InputError(where, "a colour channel is out of range for a 32-bit float");
  return color;
}

Transform parse_matrix(std::string_view text, const Location& where) {
  std::vector<double> entries;
  if (text.find(';') == std::string_view::npos) {
    entries = parse_reals(text, where, {16});
  } else {
    std::size_t row = 0;
    for (std::size_t begin = 0; begin <= text.size(); ++row) {
      const std::size_t end = std::min(text.find(';', begin), text.size());
      const std::string_view part = text.substr(begin, end - begin);
      const bool is_trailing = row == 4 && part.find_first_not_of(xml_white_space) == std::string_view::npos;
      if (row == 4 && !is_trailing)
        throw InputError(place_of_part(part, text, where), "a matrix has 4 rows; this is one more");
      if (!is_trailing) {
        const std::vector<double> numbers = parse_reals(part, place_of_part(part, text, where), {4});
        entries.insert(entries.end(), numbers.begin(), numbers.end());
      }
      begin = end + 1;
    }
    if (row < 4) throw InputError(where, fmt::format("a matrix has 4 rows split by ';', found {}", row));
  }
  Transform t;
  for (std::size_t i = 0; i < 16; ++i) t.m[i / 4][i % 4] = entries[i];
  if (t.m[3] != std::array<double, 4>{0, 0, 0, 1})
    throw InputError(
        where, "the last row of the matrix is not 0 0 0 1",
        "rows come first, and projections are not supported; was the matrix written column by column?");
  return t;
}

}  // namespace etendue
