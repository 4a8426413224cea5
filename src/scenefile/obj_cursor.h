// Where a reader stands in the text of an OBJ or MTL file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace etendue {

/// Walks the text by its words. A backslash at a line's end joins it with the next line.
class ObjCursor {
 public:
  ObjCursor(const std::string& text, std::size_t offset)
      : begin_(text.data()), at_(begin_ + offset), end_(begin_ + text.size()) {}

  bool at_end() const { return at_ == end_; }
  bool at_statement_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }
  bool at_token_end() const {
    return at_ == end_ || is_blank(*at_) || is_line_end(*at_) || continuation() > 0;
  }
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  const char* at() const { return at_; }
  const char* end() const { return end_; }
  void move_to(const char* at) { at_ = at; }

  void skip_blanks() {
    for (;;) {
      if (at_ != end_ && is_blank(*at_))
        ++at_;
      else if (const auto joined = continuation())
        at_ += joined;
      else
        return;
    }
  }

  /// Comments and statements that nobody reads are not continued: a path may end in a backslash.
  void skip_line() {
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    if (at_ != end_) ++at_;
  }

  /// True, and past it, where the next token is `word`.
  bool accept(std::string_view word) {
    if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(word)) return false;
    const auto before = at_;
    at_ += word.size();
    if (at_token_end()) return true;
    at_ = before;
    return false;
  }

  /// True, and past it, where the next character is `c`.
  bool accept(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  std::string_view take_token() {
    const auto first = at_;
    while (!at_token_end()) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// From here to the line's end, without the blanks around it and a comment behind: names and paths may hold
  /// blanks, and are not continued.
  std::string_view take_rest() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const auto first = at_;
    auto last = at_;
    for (bool is_after_blank = true; at_ != end_ && !is_line_end(*at_); ++at_) {
      if (*at_ == '#' && is_after_blank) break;
      is_after_blank = is_blank(*at_);
      if (!is_after_blank) last = at_ + 1;
    }
    return {first, static_cast<std::size_t>(last - first)};
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  std::ptrdiff_t continuation() const {
    if (at_ == end_ || *at_ != '\\' || end_ - at_ < 2) return 0;
    if (at_[1] == '\n') return 2;
    if (at_[1] != '\r') return 0;
    return end_ - at_ > 2 && at_[2] == '\n' ? 3 : 2;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

}  // namespace etendue
