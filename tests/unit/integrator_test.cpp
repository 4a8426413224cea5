// What integrators' names and keys mean in each dialect: the tables of docs/scene_format.md hold for the
// code.
#include "integrator/integrator.h"

#include "scenefile/dialect.h"
#include "scenefile/nori_xml.h"
#include "support/error_of.h"
#include "support/program.h"

#include <array>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

namespace etendue {
namespace {

using testing::HasSubstr;

bool is_same(const PathRules& a, const PathRules& b) {
  return a.direct_light == b.direct_light && a.most_vertices == b.most_vertices &&
         a.is_dirac_only == b.is_dirac_only && a.is_every_light == b.is_every_light &&
         a.light_samples == b.light_samples && a.bsdf_samples == b.bsdf_samples;
}

struct Made {
  IntegratorSettings settings;
  std::vector<UnreadKey> unread;
};

/// `<integrator type="TYPE">INSIDE</integrator>` as a file of the dialect has it.
Made make(const std::string& type, Dialect dialect, const std::string& inside = "") {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "s.xml",
                   "<scene>\n<integrator type=\"" + type + "\">\n" + inside + "</integrator></scene>");
  Made made;
  const SceneDesc description = read_nori_xml(folder.path() / "s.xml", dialect);
  made.settings = make_integrator(description.root.children.at(0), dialect, made.unread);
  return made;
}

std::string error_of(const std::string& type, Dialect dialect, const std::string& inside) {
  return test::error_of([&] { make(type, dialect, inside); });
}

std::string text_xml(const std::string& name, const std::string& value) {
  return fmt::format("<string name=\"{}\" value=\"{}\"/>\n", name, value);
}
std::string count_xml(const std::string& name, int value) {
  return fmt::format("<integer name=\"{}\" value=\"{}\"/>\n", name, value);
}

// --- The page ---

const std::string& page() {
  static const std::string text =
      test::read_file(std::filesystem::path(ETENDUE_SOURCE_DIR) / "docs/scene_format.md");
  return text;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    const std::size_t begin = cell.find_first_not_of(' ');
    cells.push_back(begin == std::string::npos ? ""
                                               : cell.substr(begin, cell.find_last_not_of(' ') + 1 - begin));
  }
  return cells;
}

/// What stands in `quotes`.
std::vector<std::string> words_of(const std::string& cell) {
  std::vector<std::string> words;
  std::istringstream stream(cell);
  bool is_quoted = false;
  for (std::string part; std::getline(stream, part, '`'); is_quoted = !is_quoted)
    if (is_quoted) words.push_back(part);
  return words;
}

/// Holds what `name` is in the dialect against a cell of the table.
void expect_means(const std::string& name, Dialect dialect, const std::string& cell) {
  const std::string what = fmt::format("{} in {}: '{}'", name, dialect_name(dialect), cell);
  const IntegratorSettings settings = make(name, dialect).settings;
  ASSERT_EQ(settings.kind, IntegratorKind::path) << what;
  if (cell.starts_with("as ")) {
    EXPECT_EQ(settings.name, words_of(cell).at(0)) << what;
    EXPECT_TRUE(is_same(settings.rules, integrator_from_name(words_of(cell).at(0)).rules)) << what;
  } else if (cell == "BSDF sampling") {
    EXPECT_EQ(settings.name, "direct") << what;
    EXPECT_TRUE(is_same(settings.rules, {.direct_light = DirectLight::bsdf})) << what;
  } else if (cell == "the sum over all lights, one sample of each") {
    EXPECT_EQ(settings.name, "every_light") << what;
    EXPECT_TRUE(is_same(settings.rules, {.direct_light = DirectLight::lights, .is_every_light = true}))
        << what;
  } else if (cell.starts_with("McGill's: ")) {
    const std::vector<std::string> words = words_of(cell);
    ASSERT_EQ(words.size(), 4u) << what;
    std::string stated_default;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const IntegratorSettings method = make(name, dialect, text_xml(words[0], words[i])).settings;
      const bool is_default = cell.find("`" + words[i] + "` (default)") != std::string::npos;
      EXPECT_EQ(is_same(method.rules, settings.rules), is_default) << what << ", " << words[i];
      if (is_default) stated_default = words[i];
    }
    EXPECT_NE(stated_default, "") << what;
  } else {
    FAIL() << what << ": this test does not know what that cell means";
  }
}

TEST(IntegratorNames, MeanInEachDialectWhatThePageSays) {
  std::vector<Dialect> dialects;
  int names = 0;
  std::istringstream lines(page());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) {
      dialects.clear();
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    if (cells[0] == "what") {
      for (std::size_t i = 1; i < cells.size(); ++i)
        dialects.push_back(dialect_from_name(words_of(cells[i]).at(0)));
    } else if (!dialects.empty() && cells[0].starts_with("integrator")) {
      ASSERT_EQ(cells.size(), dialects.size() + 1) << line;
      for (const std::string& name : words_of(cells[0])) {
        ++names;
        for (std::size_t i = 0; i < dialects.size(); ++i) expect_means(name, dialects[i], cells[i + 1]);
      }
    }
  }
  EXPECT_EQ(names, 3) << "direct, path and mipath should be in the table";
}

TEST(IntegratorNames, ThatThePageCallsOthersNamesMeanTheSame) {
  int found = 0;
  std::string section, name;
  std::istringstream lines(page());
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) section = line;
    if (section != "## Integrators") continue;
    if (line.starts_with("### `")) name = words_of(line).at(0);
    if (!line.starts_with("Another name of `")) continue;
    ++found;
    for (const std::string& dialect : dialect_names()) {
      const IntegratorSettings one = make(name, dialect_from_name(dialect)).settings,
                               other = make(words_of(line).at(0), dialect_from_name(dialect)).settings;
      EXPECT_EQ(one.name, other.name) << name;
      EXPECT_TRUE(is_same(one.rules, other.rules)) << name;
      EXPECT_EQ(one.name, integrator_from_name(name).name);
    }
  }
  EXPECT_GE(found, 5);
}

TEST(IntegratorNames, OtherThanDirectMeanTheSameInAllDialects) {
  const std::array dialects{Dialect::nori_2012, Dialect::nori_eth, Dialect::nori};
  for (const Plugin& plugin : integrator_plugins()) {
    if (plugin.name == "direct" || plugin.name == "simple") continue;
    for (const Dialect dialect : dialects) {
      const IntegratorSettings settings = make(plugin.name, dialect).settings;
      EXPECT_EQ(settings.name, integrator_from_name(plugin.name).name) << plugin.name;
      EXPECT_TRUE(is_same(settings.rules, integrator_from_name(plugin.name).rules)) << plugin.name;
    }
  }
  EXPECT_EQ(integrator_from_name("direct").rules.direct_light, DirectLight::bsdf);
}

// --- Keys ---

TEST(IntegratorKeys, TheHeuristicIsBalanceUnlessPowerIsStated) {
  for (const std::string name : {"mis", "direct_mis", "path_mis", "path", "mipath"}) {
    EXPECT_EQ(make(name, Dialect::nori).settings.rules.direct_light, DirectLight::balance) << name;
    EXPECT_EQ(make(name, Dialect::nori, text_xml("heuristic", "balance")).settings.rules.direct_light,
              DirectLight::balance);
    const Made power = make(name, Dialect::nori, text_xml("heuristic", "power"));
    EXPECT_EQ(power.settings.rules.direct_light, DirectLight::power) << name;
    EXPECT_EQ(heuristic_name(power.settings.rules.direct_light), "power");
    EXPECT_TRUE(power.unread.empty());
    EXPECT_THAT(error_of(name, Dialect::nori, text_xml("heuristic", "powr")),
                testing::AllOf(HasSubstr("s.xml:3:33: unknown heuristic 'powr'"), HasSubstr("^~~"),
                               HasSubstr("did you mean 'power'?")));
  }
  EXPECT_EQ(make("light", Dialect::nori, text_xml("heuristic", "power")).unread.size(), 1u);
}

TEST(IntegratorKeys, OfMcGillsDirect) {
  const std::string counts = count_xml("emitterSamples", 3) + count_xml("brdfSamples", 2);
  const auto made = [&](const std::string& inside) {
    return make("direct", Dialect::nori, inside + counts).settings;
  };
  EXPECT_TRUE(
      is_same(made("").rules, {.direct_light = DirectLight::bsdf, .light_samples = 0, .bsdf_samples = 2}));
  EXPECT_TRUE(is_same(made(text_xml("samplingMethod", "brdf")).rules, made("").rules));
  EXPECT_TRUE(is_same(made(text_xml("samplingMethod", "emitter")).rules,
                      {.direct_light = DirectLight::lights, .light_samples = 3, .bsdf_samples = 0}));
  EXPECT_TRUE(is_same(made(text_xml("samplingMethod", "mis")).rules,
                      {.direct_light = DirectLight::balance, .light_samples = 3, .bsdf_samples = 2}));
  EXPECT_TRUE(is_same(made(text_xml("samplingMethod", "mis") + text_xml("heuristic", "power")).rules,
                      {.direct_light = DirectLight::power, .light_samples = 3, .bsdf_samples = 2}));
  // With one of the two numbers 0, mis is the other method.
  const auto zero = [](const std::string& key) {
    return make("direct", Dialect::nori, text_xml("samplingMethod", "mis") + count_xml(key, 0)).settings;
  };
  EXPECT_EQ(zero("emitterSamples").name, "direct");
  EXPECT_EQ(zero("brdfSamples").name, "light");
  // The keys belong to this dialect alone.
  for (const Dialect dialect : {Dialect::nori_2012, Dialect::nori_eth})
    EXPECT_EQ(make("direct", dialect, counts).unread.size(), 2u);
}

TEST(IntegratorKeys, ThatAreWrongAreExplained) {
  EXPECT_THAT(error_of("direct", Dialect::nori, text_xml("samplingMethod", "emiter")),
              testing::AllOf(HasSubstr("s.xml:3:38: unknown samplingMethod 'emiter'"), HasSubstr("^~~~~~"),
                             HasSubstr("did you mean 'emitter'?"), HasSubstr("brdf"), HasSubstr("mis")));
  EXPECT_THAT(error_of("direct", Dialect::nori, count_xml("brdfSamples", 0)),
              HasSubstr("samplingMethod 'brdf' with 0 samples: the image would be black"));
  EXPECT_THAT(error_of("direct", Dialect::nori, count_xml("emitterSamples", -1)),
              HasSubstr("'emitterSamples' is -1; it must be from 0 to 65536"));
  EXPECT_THAT(error_of("path_miss", Dialect::nori, ""),
              testing::AllOf(HasSubstr("path_miss"), HasSubstr("did you mean 'path_mis'?")));
}

}  // namespace
}  // namespace etendue
