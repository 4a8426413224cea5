#include "base/error.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace etendue {
namespace {

Location place(const std::string& text, const std::string& part) {
  return {std::make_shared<SourceFile>(SourceFile{"s.xml", text}), text.find(part), part.size()};
}

TEST(FormatMessage, UnderlinesTheWordInItsLine) {
  EXPECT_EQ(format_message(place("<a>\n  <bsfd/>\n</a>\n", "bsfd"), "unknown tag", "known: bsdf"),
            "s.xml:2:4: unknown tag\n"
            "  2 |   <bsfd/>\n"
            "    |    ^~~~\n"
            "known: bsdf");
}

TEST(FormatMessage, ShowsTabsAsSpacesAndCountsThemAsOneColumn) {
  EXPECT_EQ(format_message(place("\tx\tword", "word"), "p"),
            "s.xml:1:4: p\n"
            "  1 |     x   word\n"
            "    |         ^~~~");
}

TEST(FormatMessage, CountsCharactersNotBytes) {
  EXPECT_EQ(format_message(place("汉语 é!", "!"), "p"),
            "s.xml:1:5: p\n"
            "  1 | 汉语 é!\n"
            "    |     ^");
}

TEST(FormatMessage, CutsLongLinesAroundTheCaret) {
  const std::string text = std::string(3000, 'a') + "word" + std::string(3000, 'b');
  const std::string message = format_message(place(text, "word"), "p");
  EXPECT_EQ(message, "s.xml:1:3001: p\n  1 | ..." + std::string(50, 'a') + "word" + std::string(46, 'b') +
                         "...\n    | " + std::string(53, ' ') + "^~~~");
}

TEST(FormatMessage, CutsBehindTheCaretNearTheBeginning) {
  const std::string message = format_message(place("word" + std::string(3000, 'b'), "word"), "p");
  EXPECT_EQ(message, "s.xml:1:1: p\n  1 | word" + std::string(96, 'b') + "...\n    | ^~~~");
}

TEST(FormatMessage, KeepsTheUnderlineInsideItsLine) {
  const std::string text = "ab\r\ncd";
  EXPECT_EQ(format_message({place(text, "b").source, 1, 5}, "p"), "s.xml:1:2: p\n  1 | ab\n    |  ^");
}

TEST(FormatMessage, PointsBehindTheLastCharacter) {
  const Location end{place("ab\n<c", "c").source, 5, 1};
  EXPECT_EQ(format_message(end, "p"), "s.xml:2:3: p\n  2 | <c\n    |   ^");
  const Location behind{end.source, 500, 1};
  EXPECT_EQ(format_message(behind, "p"), format_message(end, "p"));
}

TEST(LineAndColumn, DoNotDependOnWhatWasAskedBefore) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += std::string(std::size_t(i % 5), 'x') + (i % 3 == 0 ? "é\n" : "\r\n");
  const auto one = std::make_shared<const SourceFile>(SourceFile{"one", text});
  const auto other = std::make_shared<const SourceFile>(SourceFile{"other", "\n" + text});
  std::mt19937 engine(1);
  for (int i = 0; i < 2000; ++i) {
    // By turns forward in small steps and anywhere; now and then in the other file.
    const bool is_step = i % 50 < 40;
    const auto& source = i % 17 == 0 ? other : one;
    const std::size_t offset =
        (is_step ? std::size_t(i % 50) * 7 : std::size_t(engine())) % (text.size() + 1);
    const std::string before = source->text.substr(0, offset);
    const std::size_t newline = before.rfind('\n');
    std::size_t column = 1;
    // 0xA9 ends the one character here that has two bytes.
    for (std::size_t k = newline == std::string::npos ? 0 : newline + 1; k < offset; ++k)
      column += before[k] != '\xA9';
    const LineColumn at = line_and_column({source, offset, 1});
    ASSERT_EQ(at.line, 1 + std::size_t(std::count(before.begin(), before.end(), '\n'))) << offset;
    ASSERT_EQ(at.column, column) << offset;
  }
}

TEST(FormatMessage, LetsNothingThroughThatATerminalWouldActOn) {
  EXPECT_EQ(format_message(place("\x1b[2J\xff!", "!"), "p"),
            "s.xml:1:6: p\n  1 | \xEF\xBF\xBD[2J\xEF\xBF\xBD!\n    |      ^");
}

TEST(FormatMessage, NamesOnlyThePathWhereThereIsNoText) {
  EXPECT_EQ(
      format_message({std::make_shared<SourceFile>(SourceFile{"m.obj", ""}), 0, 1}, "the file is empty"),
      "m.obj: the file is empty");
  EXPECT_EQ(format_message({}, "no scene", "name one"), "no scene\nname one");
}

TEST(KnownNames, NearestFirstAndAsksWhereItMayBeASlip) {
  EXPECT_EQ(known_names("albeto", {"kd", "radiance", "albedo"}),
            "did you mean 'albedo'? known: albedo, kd, radiance");
  EXPECT_EQ(known_names("abledo", {"albedo"}), "did you mean 'albedo'? known: albedo");
  EXPECT_EQ(known_names("tranlsate", {"scale", "translate"}),
            "did you mean 'translate'? known: translate, scale");
  EXPECT_EQ(known_names("ToWorld", {"fov", "toWorld"}), "did you mean 'toWorld'? known: toWorld, fov");
  EXPECT_EQ(known_names("xyz", {"kd", "radiance"}), "known: kd, radiance");
}

TEST(KnownNames, ListsAll) {
  EXPECT_EQ(known_names("q", {"d", "c", "b", "a"}), "known: a, b, c, d");
  EXPECT_EQ(known_names("q", {}), "known: none");
}

}  // namespace
}  // namespace etendue
