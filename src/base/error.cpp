#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>

namespace etendue {
namespace {

constexpr std::size_t tab_width = 4;
constexpr std::size_t excerpt_width = 100;
constexpr const char* replacement_character = "\xEF\xBF\xBD";

/// Bytes of the UTF-8 character at the start of `text`; 0 where there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text[0]);
  const std::size_t length = byte < 0x80         ? 1
                             : byte >> 5 == 0x6  ? 2
                             : byte >> 4 == 0xE  ? 3
                             : byte >> 3 == 0x1E ? 4
                                                 : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  return length;
}

/// One column of the terminal, and the byte of the line it shows.
struct Cell {
  std::string shown;
  std::size_t offset;
};

/// Tabs as spaces; what a terminal would act on, as the replacement character.
std::vector<Cell> lay_out(std::string_view text) {
  std::vector<Cell> cells;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text.substr(at));
    const auto byte = static_cast<unsigned char>(text[at]);
    if (byte == '\t') {
      do cells.push_back({" ", at});
      while (cells.size() % tab_width != 0);
    } else if (length == 0 || byte < 0x20 || byte == 0x7F) {
      cells.push_back({replacement_character, at});
    } else {
      cells.push_back({std::string(text.substr(at, length)), at});
    }
    at += std::max<std::size_t>(length, 1);
  }
  return cells;
}

std::string single_line(std::string_view text) {
  std::string shown;
  for (const Cell& cell : lay_out(text)) shown += cell.shown;
  return shown;
}

bool has_text(const Location& where) { return where.source && !where.source->text.empty(); }

/// A place as a person counts.
struct Place {
  LineColumn at{1, 1};
  std::size_t line_begin = 0;
};

/// Counts on from the place before where that is earlier in the same file: warnings come in the file's order,
/// and thousands of them would read it from its start thousands of times.
Place marked_place(const Location& where) {
  struct Mark {
    std::weak_ptr<const SourceFile> source;
    std::size_t offset = 0;
    Place place;
  };
  thread_local Mark mark;
  const std::string_view text = where.source->text;
  const std::size_t offset = std::min(where.offset, text.size());
  if (mark.source.lock() != where.source || mark.offset > offset) mark = {where.source, 0, {}};
  Place& place = mark.place;
  while (mark.offset < offset) {
    if (text[mark.offset] == '\n') {
      place = {{place.at.line + 1, 1}, ++mark.offset};
    } else {
      mark.offset += std::max<std::size_t>(character_length(text.substr(mark.offset)), 1);
      ++place.at.column;
    }
  }
  return place;
}

/// The line of `where` and a line with the caret under it.
std::string excerpt(const Location& where) {
  const std::string_view text = where.source->text;
  const Place place = marked_place(where);
  const std::size_t begin = place.line_begin;
  // Only what can be shown is laid out: a file of one line may have millions of characters.
  const std::size_t reach = 4 * excerpt_width;
  const std::size_t offset = std::min(where.offset, text.size());
  std::size_t first_byte = offset - begin > reach ? offset - reach : begin;
  while (first_byte > begin && (static_cast<unsigned char>(text[first_byte]) & 0xC0) == 0x80) --first_byte;
  std::string_view line = text.substr(first_byte, offset - first_byte + reach);
  const bool is_cut_behind = line.find('\n', offset - first_byte) == std::string_view::npos &&
                             first_byte + line.size() < text.size();
  line = line.substr(0, std::min(line.find('\n', offset - first_byte), line.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);

  const std::vector<Cell> cells = lay_out(line);
  const auto column_of = [&](std::size_t byte) {
    return static_cast<std::size_t>(
        std::partition_point(cells.begin(), cells.end(), [&](const Cell& c) { return c.offset < byte; }) -
        cells.begin());
  };
  const std::size_t caret = column_of(offset - first_byte);
  const std::size_t caret_end = std::max(caret + 1, column_of(offset - first_byte + where.length));

  std::size_t from = 0, to = cells.size();
  if (to > excerpt_width) {
    from = caret > excerpt_width / 2 ? caret - excerpt_width / 2 : 0;
    from = std::min(from, to - std::min(to, excerpt_width));
    to = std::min(to, from + excerpt_width);
  }
  const std::string front = from > 0 || first_byte > begin ? "..." : "";
  const std::string back = to < cells.size() || is_cut_behind ? "..." : "";
  std::string shown;
  for (std::size_t i = from; i < to; ++i) shown += cells[i].shown;

  const std::string number = std::to_string(place.at.line);
  const std::size_t underlined =
      std::max<std::size_t>(std::min(caret_end, std::max(to, caret + 1)) - caret, 1);
  return fmt::format("  {} | {}{}{}\n  {} | {}^{}", number, front, shown, back,
                     std::string(number.size(), ' '), std::string(front.size() + caret - from, ' '),
                     std::string(underlined - 1, '~'));
}

/// Edits (insert, delete, replace, swap neighbours) between two names; capitals do not count.
/// Optimal string alignment: Damerau 1964, with the recurrence of Wagner and Fischer 1974.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = previous;
    previous = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

LineColumn line_and_column(const Location& where) {
  return has_text(where) ? marked_place(where).at : LineColumn{0, 0};
}

std::string format_message(const Location& where, std::string_view problem, std::string_view hint) {
  std::string message;
  if (where.source) message = single_line(where.source->path) + ":";
  if (has_text(where)) {
    const LineColumn at = line_and_column(where);
    message += fmt::format("{}:{}: {}\n{}", at.line, at.column, problem, excerpt(where));
  } else {
    message += fmt::format("{}{}", message.empty() ? "" : " ", problem);
  }
  if (!hint.empty()) message += fmt::format("\n{}", hint);
  return message;
}

std::string known_names(std::string_view wrong, std::vector<std::string> known) {
  if (known.empty()) return "known: none";
  // Beyond this a name is a mistake of another kind, and the table of distances would be large.
  wrong = wrong.substr(0, 64);
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (std::string& name : known) ranked.emplace_back(edit_distance(wrong, name), std::move(name));
  std::sort(ranked.begin(), ranked.end());

  std::string names;
  for (const auto& [distance, name] : ranked) names += (names.empty() ? "" : ", ") + name;
  const auto& [distance, nearest] = ranked.front();
  const bool is_slip = 3 * distance <= std::max(wrong.size(), nearest.size()) && wrong != nearest;
  return (is_slip ? fmt::format("did you mean '{}'? ", nearest) : std::string()) + "known: " + names;
}

}  // namespace etendue
