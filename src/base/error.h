// Errors in what the user gave us: what is wrong, where, what was expected, what to do.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// A text file as read, kept while a message may have to point into it.
struct SourceFile {
  std::string path;
  std::string text;
};

/// A place in a file. Without a source (or for binary files) only the path is known.
struct Location {
  std::shared_ptr<const SourceFile> source;
  std::size_t offset = 0;  ///< Byte offset into source->text.
  std::size_t length = 1;  ///< Bytes to underline.
};

/// Counted from 1; columns are characters, a tab being one.
struct LineColumn {
  std::size_t line, column;
};
/// {0, 0} where only the path is known.
LineColumn line_and_column(const Location& where);

/// `file:line:col: problem`, the line with a caret, and the hint on a line of its own. Tabs become spaces,
/// long lines are cut around the caret, control characters and broken UTF-8 are shown as U+FFFD.
std::string format_message(const Location& where, std::string_view problem, std::string_view hint = {});

/// Thrown for any bad input or usage; what() is the complete message for a person.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& complete_message) : std::runtime_error(complete_message) {}
  InputError(const Location& where, std::string_view problem, std::string_view hint = {})
      : std::runtime_error(format_message(where, problem, hint)) {}
};

/// A place that floats do not hold, or places that they do not tell apart. Moved nearer to the origin they
/// may do.
class PlaceError : public InputError {
 public:
  using InputError::InputError;
  explicit PlaceError(const InputError& error) : InputError(error) {}
};

/// "known: a, b, c", all of them, nearest to `wrong` first (edit distance, then alphabet). Where the
/// nearest may be what was meant, "did you mean 'a'?" comes before.
std::string known_names(std::string_view wrong, std::vector<std::string> known);

}  // namespace etendue
