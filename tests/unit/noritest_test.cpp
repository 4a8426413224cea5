// Test files of the Nori family: what is read into them, and that they pass what is right and fail what is
// not.
//
// False-alarm rate of this file: below 1e-4 (40 right p-values that must exceed 1e-6, a few judged by their
// file's own level of 0.01 where the samples have no variance), fixed seeds.
// Seen to fail when: Diffuse's samples weigh 1 % too much; its density is 1 % too large; Phong's density
// takes n for n + 1; the pixel covers only one pixel of the film; every task takes the same seed; cells are
// even in theta under every dialect; samples of a phase function are turned to a fixed direction; R0 is
// rendered as copper; the base under a coat loses nothing to the reflection along the normal.
#include "noritest/noritest.h"

#include "render/thread_limit.h"
#include "stats/quantile.h"
#include "support/error_of.h"
#include "support/program.h"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

using testing::HasSubstr;

constexpr double surely_right = 1e-6, surely_wrong = 1e-9;

class NoriTest : public testing::Test {
 protected:
  std::vector<CaseResult> run(const std::string& text, std::uint64_t seed = 1,
                              std::optional<Dialect> dialect = std::nullopt) {
    const std::filesystem::path file = folder_.path() / "t.xml";
    std::filesystem::remove(file);
    test::write_file(file, text);
    return run_test_file(read_test_file(file, dialect), {.seed = seed, .sampler = SamplerKind::independent},
                         {}, warnings_)
        .cases;
  }
  std::string error(const std::string& text) {
    return test::error_of([&] { run(text); });
  }
  static std::string ttest(const std::string& references, const std::string& rest) {
    return "<test type='ttest'><string name='references' value='" + references + "'/>" + rest + "</test>";
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

const std::string angles = "<string name='angles' value='0, 45, 80'/>";
const std::string grey_bsdf = "<bsdf type='diffuse'><color name='albedo' value='0.5'/></bsdf>";
const std::string glossy =
    "<bsdf type='phong'><color name='kd' value='.3'/><color name='ks' value='.4'/><float name='n' "
    "value='30'/></bsdf>";

TEST_F(NoriTest, BsdfsUnderUniformLight) {
  const std::vector<CaseResult> results = run(ttest("0.5 0.5 0.5", angles + grey_bsdf));
  ASSERT_EQ(results.size(), 3u);
  for (const CaseResult& result : results) {
    EXPECT_TRUE(result.is_passed);
    EXPECT_NEAR(result.mean, 0.5, 1e-6);
    EXPECT_EQ(result.reference, 0.5);
    EXPECT_EQ(result.kind, "ttest");
    EXPECT_EQ(result.type, "diffuse");
    EXPECT_TRUE(result.is_reference_estimated);
  }
  EXPECT_EQ(results[1].detail, "at 45 degrees");
  // Modified Phong seen along the normal reflects kd + ks.
  const CaseResult phong = run(ttest("0.7", "<string name='angles' value='0'/>" + glossy))[0];
  EXPECT_NEAR(phong.mean, 0.3 + 0.4, 0.01);
  EXPECT_GT(phong.p_value, surely_right);
}

TEST_F(NoriTest, AnErrorOfOnePercentFails) {
  for (const CaseResult& result : run(ttest("0.505 0.505 0.505", angles + grey_bsdf))) {
    EXPECT_FALSE(result.is_passed);
    EXPECT_LT(result.p_value, surely_wrong);
  }
}

TEST_F(NoriTest, TheForksWaysToCountReferences) {
  const std::string dark = "<bsdf type='diffuse'><color name='albedo' value='0.25'/></bsdf>";
  const auto passes = [&](const std::string& references, const std::string& given_angles,
                          const std::string& bsdfs) {
    const std::vector<CaseResult> results =
        run(ttest(references, "<string name='angles' value='" + given_angles + "'/>" + bsdfs));
    int passed = 0;
    for (const CaseResult& result : results) passed += result.is_passed;
    return std::pair(results.size(), passed);
  };
  EXPECT_EQ(passes(".5 .5 .25 .25", "0 60", grey_bsdf + dark), std::pair(std::size_t{4}, 4))
      << "ETH, Tuebingen";
  EXPECT_EQ(passes(".5 .5", "0 60", grey_bsdf + grey_bsdf), std::pair(std::size_t{4}, 4)) << "2012";
  EXPECT_EQ(passes(".5 .5", "0 60 10 70", grey_bsdf + grey_bsdf), std::pair(std::size_t{4}, 4))
      << "since 2015";
  EXPECT_EQ(passes(".5 .25 .5 .25", "0 60", grey_bsdf + dark), std::pair(std::size_t{4}, 2))
      << "BSDF by BSDF";
  const std::vector<CaseResult> own =
      run(ttest(".5 .5", "<string name='angles' value='0 60 10 70'/>" + grey_bsdf + grey_bsdf));
  EXPECT_EQ(own[3].detail, "at 70 degrees");
}

TEST_F(NoriTest, EmittersAtDistances) {
  const std::string point = "<emitter type='point'><color name='power' value='1'/></emitter>",
                    aside =
                        "<emitter type='point'><color name='power' value='100'/><point name='position' "
                        "value='3 0 0'/></emitter>",
                    distances = "<string name='distances' value='0.1 4'/>";
  // Intensity / distance^2: to the origin, and to (3, 0, 0).
  const double intensity = 1 / (4 * std::numbers::pi);
  const double expected[]{intensity / 0.01, intensity / 16, 100 * intensity / 9.01, 100 * intensity / 25};
  std::string references;
  for (const double value : expected) references += std::to_string(value) + " ";
  const std::vector<CaseResult> results = run(ttest(references, distances + point + aside));
  ASSERT_EQ(results.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(results[i].is_passed) << i;
    EXPECT_NEAR(results[i].mean / expected[i], 1, 1e-5);
    EXPECT_EQ(results[i].subject, "emitter");
  }
  EXPECT_EQ(results[3].detail, "at 4 m");
  EXPECT_FALSE(run(ttest("8.03", "<string name='distances' value='0.1'/>" + point))[0].is_passed);
  EXPECT_THAT(error(ttest("1", distances + point)), HasSubstr("1 references for 2 distances and 1 emitters"));
  EXPECT_TRUE(run(ttest("1 1", distances + "<emitter type='area'/>"))[0].is_error);
}

TEST_F(NoriTest, RefusesTestsThatMakeNoSense) {
  EXPECT_THAT(error(ttest("1 2", angles + grey_bsdf)), HasSubstr("2 references for 3 angles and 1 BSDFs"));
  EXPECT_THAT(error(ttest("1 2", "<scene/>")), HasSubstr("2 references for 1 scenes"));
  EXPECT_THAT(error(ttest("1", "<scene/>" + grey_bsdf)), HasSubstr("several kinds"));
  EXPECT_THAT(error(ttest("1", "")), HasSubstr("nothing to test"));
  EXPECT_THAT(error("<test type='ttest'/>"), HasSubstr("lacks 'references'"));
  EXPECT_THAT(error(ttest("1", "<integer name='sampleCount' value='1'/>" + grey_bsdf)),
              HasSubstr("at least 2"));
  EXPECT_THAT(error(ttest("1", "<float name='significanceLevel' value='1'/>" + grey_bsdf)),
              HasSubstr("between 0 and 1"));
  EXPECT_THAT(error("<test type='chi2test'/>"), HasSubstr("nothing to test"));
  EXPECT_THAT(error("<test type='chi2test'><integer name='resolution' value='0'/></test>"),
              HasSubstr("it must be from 1"));
  EXPECT_THAT(error("<test type='tttest'/>"), HasSubstr("did you mean 'ttest'?"));
  EXPECT_THAT(error("<scene/>"), HasSubstr("the root is <scene>, not <test>"));
}

TEST_F(NoriTest, OneBadCaseDoesNotStopTheOthers) {
  const std::vector<CaseResult> results =
      run(ttest(".5 .5 .5 .5 .5 .5", angles + "<bsdf type='difuse'/>" + grey_bsdf));
  ASSERT_EQ(results.size(), 6u);
  EXPECT_TRUE(results[0].is_error);
  EXPECT_FALSE(results[0].is_passed);
  EXPECT_THAT(results[0].problem, HasSubstr("did you mean 'diffuse'?"));
  EXPECT_TRUE(results[3].is_passed);
}

/// A camera at the origin that looks along -z with +x to the right (nori-eth), over a film of 5 x 3 pixels.
std::string scene(const std::string& inside, const std::string& integrator = "light") {
  return "<scene><integrator type='" + integrator +
         "'/><camera type='perspective'><float name='fov' value='60'/><integer name='width' value='5'/>"
         "<integer name='height' value='3'/><transform name='toWorld'><lookat origin='0 0 0' target='0 0 -1' "
         "up='0 1 0'/></transform></camera>" +
         inside + "</scene>";
}

/// A light that faces the camera, of radiance 2, from x to infinity.
std::string light_from(double x) {
  return "<shape type='rectangle'><transform name='toWorld'><scale value='500 500 1'/><translate value='" +
         std::to_string(500 + x) +
         " 0 -1'/></transform><emitter type='area'><color name='radiance' value='2'/></emitter></shape>";
}

TEST_F(NoriTest, SamplesOfASceneAreUniformOverTheWholeFilm) {
  const double half_width = std::tan(std::numbers::pi / 6);
  // The light covers the film from the given share of its half width on.
  for (const double from : {-0.5, 0.0, 0.3, 0.9}) {
    const std::vector<CaseResult> results =
        run(ttest(std::to_string(1 - from), scene(light_from(from * half_width))));
    ASSERT_EQ(results.size(), 1u);
    EXPECT_GT(results[0].p_value, surely_right) << from << ": mean " << results[0].mean;
    EXPECT_EQ(results[0].type, "light");
    EXPECT_EQ(results[0].subject, "scene");
    EXPECT_FALSE(results[0].is_reference_estimated);
  }
}

TEST_F(NoriTest, StatisticsOfManySeedsSpreadAsTheTestAssumes) {
  const std::string test = ttest("1", "<integer name='sampleCount' value='65536'/>" + scene(light_from(0)));
  constexpr int seeds = 40;
  double sum_sq = 0;
  for (int seed = 0; seed < seeds; ++seed) sum_sq += std::pow(run(test, std::uint64_t(seed))[0].statistic, 2);
  EXPECT_GT(sum_sq, chi_squared_quantile(1e-6, seeds));
  EXPECT_LT(sum_sq, chi_squared_quantile(1 - 1e-6, seeds));
}

TEST_F(NoriTest, TheFloorOfTheVarianceDependsOnTheGeneration) {
  // All samples are exactly 2: only the floor gives the mean an error bar, of 1e-5 or 3.2e-5.
  const std::string test = ttest("2.00008", scene(light_from(-500)));
  EXPECT_FALSE(run(test, 1, Dialect::nori)[0].is_passed);
  EXPECT_FALSE(run(test, 1, Dialect::nori_eth)[0].is_passed);
  EXPECT_TRUE(run(test, 1, Dialect::nori_2012)[0].is_passed);
}

TEST_F(NoriTest, BlackNeverPassesForAnythingElse) {
  const std::string behind = scene(
      "<shape type='sphere'><point name='center' value='0 0 50'/>"
      "<emitter type='area'/></shape>");
  const CaseResult black = run(ttest("1e-9", behind))[0];
  EXPECT_FALSE(black.is_passed);
  EXPECT_EQ(black.mean, 0);
  EXPECT_EQ(black.problem, "all samples are 0");
  EXPECT_TRUE(run(ttest("0", behind))[0].is_passed);
}

TEST_F(NoriTest, ASampleThatIsNotFiniteFails) {
  const std::string floor =
      "<shape type='rectangle'><transform name='toWorld'><scale value='9 9 1'/><translate value='0 0 -5'/>"
      "</transform></shape>";
  const std::string blinding =
      "<shape type='rectangle'><transform name='toWorld'><scale value='9 9 1'/><rotate axis='1 0 0' "
      "angle='180'/><translate value='0 0 5'/></transform><emitter type='area'><color name='radiance' "
      "value='3e38'/></emitter></shape>";
  const CaseResult result = run(ttest("1", scene(floor + blinding)))[0];
  EXPECT_FALSE(result.is_passed);
  EXPECT_FALSE(result.is_error);
  EXPECT_THAT(result.problem, HasSubstr("negative or not finite"));
}

TEST_F(NoriTest, SamplesOfBsdfsFollowTheirDensity) {
  for (const Dialect dialect : {Dialect::nori, Dialect::nori_2012}) {
    const std::vector<CaseResult> results =
        run("<test type='chi2test'>" + grey_bsdf + glossy +
                "<bsdf type='phong'><color name='ks' value='.9'/><color name='kd' value='0'/><float name='n' "
                "value='2000'/></bsdf></test>",
            1, dialect);
    ASSERT_EQ(results.size(), 15u);
    for (const CaseResult& result : results) {
      EXPECT_TRUE(result.problem.empty()) << result.problem;
      EXPECT_GT(result.p_value, surely_right) << result.type << " " << result.detail;
      EXPECT_TRUE(std::isnan(result.mean) && std::isnan(result.reference));
      EXPECT_GT(result.statistic, 0);
    }
    EXPECT_EQ(results[7].detail, "direction 3");
  }
}

TEST_F(NoriTest, SamplesOfPhaseFunctionsFollowTheirDensity) {
  const std::vector<CaseResult> results = run(
      "<test type='chi2test'><phase type='hg'><float name='g' value='-0.4'/></phase><phase type='isotropic'/>"
      "<bsdf type='diffuse'/></test>");
  ASSERT_EQ(results.size(), 15u);
  for (const CaseResult& result : results) EXPECT_GT(result.p_value, surely_right) << result.problem;
  EXPECT_EQ(results[0].subject, "phase");
  EXPECT_EQ(results[0].type, "hg");
  EXPECT_EQ(results[14].subject, "bsdf");
}

// Integrals over the hemisphere by the midpoint rule, of the formulas as docs/scene_format.md has them.
TEST_F(NoriTest, RoughSurfacesOfZaragoza) {
  const std::string angles_of_two = "<string name='angles' value='0, 50'/>";
  for (const auto& [references, bsdf] : std::vector<std::pair<std::string, std::string>>{
           {"0.45324, 0.42068",
            "<bsdf type='roughconductor'><color name='R0' value='.2 .5 .8'/><float name='alpha' "
            "value='.4'/></bsdf>"},
           {"0.42428, 0.39593",
            "<bsdf type='roughsubstrate'><color name='kd' value='.6 .4 .1'/><float name='alpha' "
            "value='.25'/><float name='intIOR' value='1.4'/><float name='extIOR' value='1'/></bsdf>"}})
    for (const CaseResult& result : run(ttest(references, angles_of_two + bsdf)))
      EXPECT_GT(result.p_value, surely_right) << bsdf << result.mean;
}

// Every ray runs along the axis, to the pole of the ball: |n| there is (0, 0, 1).
TEST_F(NoriTest, ACameraWhoseUpIsItsDirectionSeesOnePoint) {
  const CaseResult result =
      run(ttest("0.072169",
                "<scene><integrator type='normals'/><camera type='perspective'><integer name='width' "
                "value='3'/><integer name='height' value='2'/><float name='fov' value='70'/><transform "
                "name='toWorld'><lookat origin='0,0,9' target='0,0,2' up='0,0,1'/></transform></camera>"
                "<shape type='sphere'/></scene>"))[0];
  EXPECT_TRUE(result.is_passed);
  EXPECT_NEAR(result.mean, 0.072169, 1e-7);
}

TEST_F(NoriTest, ALobeTooNarrowForTheCellsIsNoMisfit) {
  const auto rough = [](const char* alpha, const char* rows) {
    return fmt::format(
        "<test type='chi2test'><integer name='testCount' value='2'/><integer name='resolution' value='{}'/>"
        "<integer name='sampleCount' value='500000'/><bsdf type='roughconductor'><float name='alpha' "
        "value='{}'/></bsdf></test>",
        rows, alpha);
  };
  for (const CaseResult& result : run(rough("0.001", "10"))) {
    EXPECT_TRUE(result.is_error);
    EXPECT_THAT(result.problem, HasSubstr("too narrow"));
  }
  for (const CaseResult& result : run(rough("0.02", "10"))) EXPECT_GT(result.p_value, surely_right);
  for (const CaseResult& result : run(rough("0.005", "40"))) EXPECT_GT(result.p_value, surely_right);
}

TEST_F(NoriTest, MoreSamplesThanCanBeNumberedAreRefused) {
  const std::string start = "<test type='chi2test'><integer name='resolution' value='900'/>";
  EXPECT_THAT(error(start + grey_bsdf + "</test>"), HasSubstr("state a 'sampleCount'"));
}

TEST_F(NoriTest, AScenesLightsThatTheIntegratorCannotSeeAreToldOf) {
  const std::string floor = "<shape type='rectangle'/>";
  const CaseResult unlit = run(ttest("1", scene(floor)))[0];
  EXPECT_TRUE(unlit.is_error);
  EXPECT_THAT(unlit.problem, HasSubstr("no light"));
  EXPECT_TRUE(run(ttest("0", scene(floor)))[0].is_passed);
  run(ttest("0", scene(floor + "<emitter type='point'/>", "direct_mats")));
  ASSERT_FALSE(warnings_.empty());
  EXPECT_THAT(warnings_.back(), HasSubstr("will not shine"));
}

TEST_F(NoriTest, ResultsDependOnTheSeedAloneNotOnThreads) {
  const std::string tests[]{
      ttest("1", scene(light_from(0))), ttest("0.7 0.7 0.7", angles + glossy),
      "<test type='chi2test'><integer name='testCount' value='1'/>" + glossy + "</test>"};
  for (const std::string& text : tests) {
    const CaseResult all = run(text)[0], other_seed = run(text, 2)[0];
    const ThreadLimit one_thread(1);
    const CaseResult one = run(text)[0];
    EXPECT_EQ(all.statistic, one.statistic);
    EXPECT_EQ(all.p_value, one.p_value);
    EXPECT_NE(all.statistic, other_seed.statistic);
  }
}

TEST_F(NoriTest, WarnsOfKeysThatNobodyReads) {
  run(ttest("0.5 0.5 0.5", angles + "<float name='tolerance' value='1'/>" +
                               "<bsdf type='diffuse'><color name='reflectance' value='1'/></bsdf>"));
  ASSERT_GE(warnings_.size(), 2u);
  EXPECT_THAT(warnings_[0], HasSubstr("unknown key 'tolerance' of test 'ttest'"));
  EXPECT_THAT(warnings_[1], HasSubstr("unknown key 'reflectance'"));
}

}  // namespace
}  // namespace etendue
