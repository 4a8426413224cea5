#include "base/error.h"

#include <gtest/gtest.h>

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

TEST(KnownNames, ListsAtMostAsManyAsAsked) {
  EXPECT_EQ(known_names("q", {"d", "c", "b", "a"}, 2), "known: a, b, ...");
  EXPECT_EQ(known_names("q", {}), "known: none");
}

}  // namespace
}  // namespace etendue
