// What integrators' names and keys mean in each dialect.
#include "integrator/integrator.h"

#include "scenefile/dialect.h"
#include "scenefile/nori_xml.h"
#include "support/error_of.h"
#include "support/program.h"

#include <array>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(IntegratorNames, DirectMeansAnotherThingInEachDialect) {
  const IntegratorSettings nori_2012 = make("direct", Dialect::nori_2012).settings,
                           nori_eth = make("direct", Dialect::nori_eth).settings;
  EXPECT_EQ(nori_2012.name, "direct");
  EXPECT_TRUE(is_same(nori_2012.rules, {.direct_light = DirectLight::bsdf}));
  EXPECT_EQ(nori_eth.name, "every_light");
  EXPECT_TRUE(is_same(nori_eth.rules, {.direct_light = DirectLight::lights, .is_every_light = true}));
  EXPECT_EQ(make("direct", Dialect::nori).settings.name, "direct");  // more of it: OfMcGillsDirect
}

TEST(IntegratorNames, OtherThanDirectMeanTheSameInAllDialects) {
  const std::array dialects{Dialect::nori_2012, Dialect::nori_eth, Dialect::nori};
  for (const Plugin& plugin : integrator_plugins()) {
    if (plugin.name == "direct" || plugin.name == "simple") continue;
    for (const Dialect dialect : dialects) {
      const IntegratorSettings settings = make(plugin.name, dialect).settings;
      EXPECT_EQ(settings.name, integrator_from_name(plugin.name).name) << plugin.name;
      EXPECT_TRUE(is_same(settings.rules, integrator_from_name(plugin.name).rules)) << plugin.name;
      // An alias is what it is another name of.
      EXPECT_TRUE(is_same(settings.rules, integrator_from_name(settings.name).rules)) << plugin.name;
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
