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

const PathRules& rules_of(const IntegratorSettings& settings) { return *settings.path_rules(); }

/// Of those that find light by both techniques.
Heuristic heuristic_of(const IntegratorSettings& settings) { return *settings.path_rules()->heuristic(); }

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

std::string error_of_integrator(const std::string& type, Dialect dialect, const std::string& inside) {
  return test::error_of([&] { make(type, dialect, inside); });
}

std::string text_xml(const std::string& name, const std::string& value) {
  return fmt::format("<string name=\"{}\" value=\"{}\"/>\n", name, value);
}
std::string count_xml(const std::string& name, int value) {
  return fmt::format("<integer name=\"{}\" value=\"{}\"/>\n", name, value);
}

TEST(IntegratorText, SaysAllRules) {
  EXPECT_EQ(describe({"mis", PathRules::direct(ByBoth{Heuristic::power, {3, "power"}, 2})}),
            "mis heuristic=power light_samples=3 sampler=power bsdf_samples=2");
  EXPECT_EQ(describe(integrator_from_name("average")),
            "average heuristic=average light_samples=1 sampler=uniform bsdf_samples=1");
  EXPECT_EQ(describe(integrator_from_name("every_light")), "every_light light_samples=1 sampler=all");
  EXPECT_EQ(describe({"direct", PathRules::direct(ByBsdf{5})}), "direct bsdf_samples=5");
  EXPECT_EQ(describe(with_bsdf_samples(integrator_from_name("path"), 4)),
            "path heuristic=power light_samples=1 sampler=tree candidates=by_scene technique=auto "
            "bsdf_samples=4 only_where_glossy outline_rays=16 survival_factor=2");
  EXPECT_EQ(describe(integrator_from_name("normals")), "normals");
  EXPECT_EQ(describe(integrator_from_name("material")), "material");
  EXPECT_EQ(describe({"av", VisibilityRules{.length = 0.1f, .background = 1}}),
            "av cosine_weighted=false length=0.1 background=1");
  EXPECT_EQ(describe({"simple", SimpleLight{{1, -2.5f, 3}, {10, 20, 30}}}),
            "simple position=1,-2.5,3 energy=10,20,30");
}

TEST(IntegratorNames, DirectMeansAnotherThingInEachDialect) {
  const IntegratorSettings nori_2012 = make("direct", Dialect::nori_2012).settings,
                           nori_eth = make("direct", Dialect::nori_eth).settings;
  EXPECT_EQ(nori_2012.name, "direct");
  EXPECT_EQ(rules_of(nori_2012), PathRules::direct(ByBsdf{}));
  EXPECT_EQ(nori_eth.name, "every_light");
  EXPECT_EQ(rules_of(nori_eth), PathRules::direct(ByLights{{.sampler = "all"}}));
  EXPECT_EQ(make("direct", Dialect::nori).settings.name, "direct");  // more of it: OfMcGillsDirect
}

TEST(IntegratorNames, OtherThanDirectMeanTheSameInAllDialects) {
  const std::array dialects{Dialect::nori_2012, Dialect::nori_eth, Dialect::nori};
  for (const Plugin& plugin : integrator_plugins()) {
    if (plugin.name == "direct" || plugin.name == "simple") continue;
    for (const Dialect dialect : dialects) {
      const IntegratorSettings settings = make(plugin.name, dialect).settings;
      EXPECT_EQ(settings.name, integrator_from_name(plugin.name).name) << plugin.name;
      ASSERT_EQ(settings.needs_lights(), integrator_from_name(plugin.name).needs_lights()) << plugin.name;
      if (!settings.needs_lights()) continue;
      EXPECT_EQ(rules_of(settings), rules_of(integrator_from_name(plugin.name))) << plugin.name;
      // An alias is what it is another name of.
      EXPECT_EQ(rules_of(settings), rules_of(integrator_from_name(settings.name))) << plugin.name;
    }
  }
  EXPECT_EQ(rules_of(integrator_from_name("direct")), PathRules::direct(ByBsdf{}));
}

// --- Keys ---

TEST(IntegratorKeys, TheHeuristicIsThatOfTheHandoutsUnlessStated) {
  EXPECT_EQ(heuristic_of(make("direct_light", Dialect::nori).settings), Heuristic::power);
  for (const std::string name : {"mis", "direct_mis", "path_mis", "path", "mipath"}) {
    EXPECT_EQ(heuristic_of(make(name, Dialect::nori).settings),
              name == "path" ? Heuristic::power : Heuristic::balance)
        << name;
    EXPECT_EQ(heuristic_of(make(name, Dialect::nori, text_xml("heuristic", "balance")).settings),
              Heuristic::balance);
    const Made power = make(name, Dialect::nori, text_xml("heuristic", "power"));
    EXPECT_EQ(heuristic_of(power.settings), Heuristic::power) << name;
    EXPECT_EQ(heuristic_name(power.settings), "power");
    EXPECT_TRUE(power.unread.empty());
    EXPECT_THAT(error_of_integrator(name, Dialect::nori, text_xml("heuristic", "powr")),
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
  const auto made_rules = [&](const std::string& inside) { return rules_of(made(inside)); };
  EXPECT_EQ(made_rules(""), PathRules::direct(ByBsdf{2}));
  EXPECT_EQ(made_rules(text_xml("samplingMethod", "brdf")), made_rules(""));
  EXPECT_EQ(made_rules(text_xml("samplingMethod", "emitter")), PathRules::direct(ByLights{{.count = 3}}));
  EXPECT_EQ(made_rules(text_xml("samplingMethod", "mis")),
            PathRules::direct(ByBoth{Heuristic::balance, {.count = 3}, 2}));
  EXPECT_EQ(made_rules(text_xml("samplingMethod", "mis") + text_xml("heuristic", "power")),
            PathRules::direct(ByBoth{Heuristic::power, {.count = 3}, 2}));
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

TEST(LightSamplerOfAnIntegrator, IsUniformUnlessAskedForAnother) {
  EXPECT_EQ(integrator_from_name("path_mis").light_sampler(), "uniform");
  EXPECT_EQ(integrator_from_name("every_light").light_sampler(), "all");
  EXPECT_EQ(integrator_from_name("direct").light_sampler(), "");
  EXPECT_EQ(integrator_from_name("normals").light_sampler(), "");
  const IntegratorSettings by_power = with_light_sampler(integrator_from_name("mis"), "power");
  EXPECT_EQ(by_power.light_sampler(), "power");
  EXPECT_EQ(by_power.name, "mis");
  EXPECT_EQ(rules_of(with_light_sampler(by_power, "uniform")), rules_of(integrator_from_name("mis")));
  EXPECT_EQ(with_light_sampler(integrator_from_name("every_light"), "uniform").name, "light");
  EXPECT_EQ(with_light_sampler(integrator_from_name("light"), "all").name, "every_light");
  EXPECT_THAT(test::error_of([] { with_light_sampler(integrator_from_name("light"), "powr"); }),
              testing::AllOf(HasSubstr("unknown light sampler 'powr'"), HasSubstr("did you mean 'power'?"),
                             HasSubstr("uniform"), HasSubstr("all")));
  for (const char* name : {"direct", "path_mats", "normals"})
    EXPECT_THAT(test::error_of([&] { with_light_sampler(integrator_from_name(name), "power"); }),
                HasSubstr("takes no samples of the lights"));
}

TEST(LightSamplesOfAnIntegrator, AreAsManyAsAskedForAtTheFirstVertex) {
  const IntegratorSettings paths = with_shadow_rays(integrator_from_name("path_mis"), 5),
                           candidates = with_candidates(paths, 7);
  EXPECT_EQ(paths.name, "path_mis");
  EXPECT_EQ(rules_of(paths).light_count(0), 5);
  EXPECT_EQ(rules_of(paths).light_count(1), 1);
  EXPECT_EQ(rules_of(paths).candidates(0), 1);
  EXPECT_EQ(rules_of(candidates).candidates(0), 7);
  EXPECT_EQ(rules_of(candidates).candidates(1), 1);
  EXPECT_EQ(rules_of(candidates).light_draws(0), 35);
  EXPECT_EQ(with_light_technique(paths, "projected").light_technique(), "projected");
  EXPECT_EQ(rules_of(with_light_technique(with_light_technique(paths, "auto"), "area")), rules_of(paths));
  for (const int number : {0, -1, 65537})
    EXPECT_THAT(test::error_of([&] { with_shadow_rays(integrator_from_name("light"), number); }),
                HasSubstr("expected from 1 to 65536"));
  for (const int number : {0, -1, 1025})
    EXPECT_THAT(test::error_of([&] { with_candidates(integrator_from_name("light"), number); }),
                HasSubstr("expected from 1 to 1024"));
  for (const char* name : {"direct", "path_mats", "normals"}) {
    EXPECT_THAT(test::error_of([&] { with_shadow_rays(integrator_from_name(name), 2); }),
                HasSubstr("takes no samples of the lights"));
    EXPECT_THAT(test::error_of([&] { with_candidates(integrator_from_name(name), 2); }),
                HasSubstr("takes no samples of the lights"));
    EXPECT_THAT(test::error_of([&] { with_light_technique(integrator_from_name(name), "area"); }),
                HasSubstr("takes no samples of the lights"));
  }
}

TEST(BsdfSamplesOfAnIntegrator, AreAsManyAsAskedForAtTheFirstVertex) {
  for (const char* name : {"path", "direct_light", "direct", "mis", "average", "path_mats", "path_mis"}) {
    const IntegratorSettings several = with_bsdf_samples(integrator_from_name(name), 4);
    EXPECT_EQ(several.name, name);
    EXPECT_EQ(rules_of(several).bsdf_samples(0), 4) << name;
    EXPECT_LE(rules_of(several).bsdf_samples(1), 1) << name;
    EXPECT_EQ(rules_of(with_bsdf_samples(several, 1)), rules_of(integrator_from_name(name))) << name;
  }
  for (const int number : {0, -1, 65537})
    EXPECT_THAT(test::error_of([&] { with_bsdf_samples(integrator_from_name("path"), number); }),
                HasSubstr("expected from 1 to 65536"));
  for (const char* name : {"light", "every_light", "path_ems", "whitted", "normals"})
    EXPECT_THAT(test::error_of([&] { with_bsdf_samples(integrator_from_name(name), 2); }),
                HasSubstr("does not look for light by samples of the BSDF"));
  // Numbers of samples are 32-bit: those of all paths count.
  const IntegratorSettings many = with_bsdf_samples(integrator_from_name("path_mis"), 1000);
  EXPECT_EQ(rules_of(many).most_samples(), 1000);
  EXPECT_EQ(rules_of(with_shadow_rays(many, 3000)).most_samples(), 3000);
}

TEST(LightBudgetOfAnIntegrator, IsWhatItWasGiven) {
  const LightBudget budget{2, 3, 5, 4};
  for (const char* name : {"path", "direct_light"}) {
    const IntegratorSettings open = integrator_from_name(name), given = with_light_budget(open, budget);
    EXPECT_TRUE(has_open_light_budget(open));
    EXPECT_FALSE(has_open_light_budget(given));
    EXPECT_EQ(light_budget(given), budget);
    EXPECT_EQ(rules_of(given).light_count(1), rules_of(open).light_count(0));
    EXPECT_FALSE(has_open_light_budget(with_candidates(open, 1)));
  }
}

TEST(HeuristicOfAnIntegrator, IsThatAskedForWhereThereIsOne) {
  for (const char* name : {"mis", "path_mis", "path", "direct_light"}) {
    const IntegratorSettings by_default = integrator_from_name(name);
    const IntegratorSettings power = with_heuristic(by_default, "power");
    EXPECT_EQ(power.name, name);
    EXPECT_EQ(heuristic_name(power), "power");
    EXPECT_EQ(rules_of(with_heuristic(power, heuristic_name(by_default))), rules_of(by_default));
  }
  for (const char* name : {"light", "direct", "average", "normals"})
    EXPECT_THAT(test::error_of([&] { with_heuristic(integrator_from_name(name), "power"); }),
                HasSubstr("does not weigh"));
  EXPECT_THAT(test::error_of([] { with_heuristic(integrator_from_name("mis"), "powr"); }),
              testing::AllOf(HasSubstr("unknown heuristic 'powr'"), HasSubstr("did you mean 'power'?")));
}

TEST(IntegratorKeys, ThatAreWrongAreExplained) {
  EXPECT_THAT(error_of_integrator("direct", Dialect::nori, text_xml("samplingMethod", "emiter")),
              testing::AllOf(HasSubstr("s.xml:3:38: unknown samplingMethod 'emiter'"), HasSubstr("^~~~~~"),
                             HasSubstr("did you mean 'emitter'?"), HasSubstr("brdf"), HasSubstr("mis")));
  EXPECT_THAT(error_of_integrator("direct", Dialect::nori, count_xml("brdfSamples", 0)),
              HasSubstr("samplingMethod 'brdf' with 0 samples: the image would be black"));
  EXPECT_THAT(error_of_integrator("direct", Dialect::nori, count_xml("emitterSamples", -1)),
              HasSubstr("'emitterSamples' is -1; it must be from 0 to 65536"));
  EXPECT_THAT(error_of_integrator("path_miss", Dialect::nori, ""),
              testing::AllOf(HasSubstr("path_miss"), HasSubstr("did you mean 'path_mis'?")));
}

}  // namespace
}  // namespace etendue
