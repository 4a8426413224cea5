// What lint says of scenes that are broken in one way each, and that it says nothing of good ones.
#include "lint/lint.h"

#include "support/data_folder.h"
#include "test_scene.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace etendue::test {
namespace {

std::vector<Finding> findings_of(const LoadedScene& loaded, std::string_view integrator,
                                 int samples_per_pixel = 16, std::string_view light_sampler = {}) {
  IntegratorSettings settings = integrator_from_name(integrator);
  if (!light_sampler.empty()) settings = with_light_sampler(settings, light_sampler);
  return lint({loaded.scene, loaded.places, settings, samples_per_pixel}, thorough);
}

std::string text_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += fmt::format("{} ", finding.id);
  return text.substr(0, text.empty() ? 0 : text.size() - 1);
}

constexpr Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

std::string camera(const Vec3d& origin = {0, -4, 1.5}, const Vec3d& target = {0, 0, 0},
                   std::string_view more = {}) {
  return camera_xml(origin, target, 60, 32, "independent", more);
}
std::string floor(std::string_view inside = diffuse_xml(0.5)) {
  return rectangle_xml({0, 0, 0}, 3 * x, 3 * y, inside);
}
std::string lamp_xml(double radiance = 1) { return diffuse_xml(0) + light_xml(radiance); }
/// Two metres up, shining down.
std::string lamp(double height = 2) { return rectangle_xml({0, 0, height}, 0.5 * x, -0.5 * y, lamp_xml()); }
std::string row_of_lamps(int count) {
  std::string all;
  for (int k = 0; k < count; ++k) all += rectangle_xml({0.2 * k - 1, 0, 2}, 0.05 * x, -0.05 * y, lamp_xml());
  return all;
}
std::string point(const Vec3d& at) {
  return fmt::format(
      "<luminaire type=\"point\"><point name=\"position\" value=\"{}\"/><color name=\"intensity\" "
      "value=\"1\"/></luminaire>",
      etendue::text_of(at));
}
const std::string glass = "<bsdf type=\"dielectric\"/>", mirror = "<bsdf type=\"mirror\"/>";
/// A square of two triangles at z = 0 that faces down.
const SceneFile square{"square.obj", "v -1 -1 0\nv -1 1 0\nv 1 1 0\nv 1 -1 0\nf 1 2 3\nf 1 3 4\n"};
std::string square_lamp(std::string_view transform) {
  return mesh_xml("square.obj",
                  fmt::format("<transform name=\"toWorld\">{}</transform>{}", transform, lamp_xml()));
}
const SceneFile box_outward{"box.obj", box_obj({0, 0, 0}, 1, false)};
const SceneFile box_inward{"room.obj", box_obj({0, 0, 0}, 5, true)};

struct Case {
  std::string name, body, integrator, expected;
  std::vector<SceneFile> files = {};
  int samples_per_pixel = 16;
  std::string light_sampler = {};
};

std::vector<Case> cases() {
  const std::string sides = rectangle_xml({1, 0, 0}, y, z, glass);
  std::string lamps;
  for (int k = 0; k < 40; ++k) lamps += rectangle_xml({0.1 * k - 2, 0, 2}, 0.04 * x, -0.04 * y, lamp_xml());
  return {
      // Good ones.
      {"Good", camera() + floor() + lamp(), "mis", ""},
      {"GoodInARoom",
       camera() + mesh_xml("room.obj", diffuse_xml(0.5)) + lamp(),
       "path_mis",
       "",
       {box_inward}},
      {"GoodByPoint", camera() + floor() + point({0, 0, 2}), "light", ""},
      {"GoodLampToLookAt", camera({0, 0, 0}, {0, 0, 2}) + lamp(), "light", ""},
      {"GoodSmallAndFar",
       camera({0, -4, 100}, {0, 0, 100}) + sphere_xml({0, 0, 100}, 0.5, diffuse_xml(0.5)) +
           rectangle_xml({0, 0, 0}, x, y, lamp_xml()),
       "light", ""},
      {"GoodGlassBall", camera() + floor() + lamp() + sphere_xml({0, 0, 0.6}, 0.5, glass), "path_mis", ""},
      {"GoodCameraInGlass", camera() + floor() + lamp() + sphere_xml({0, -4, 1.5}, 0.3, glass), "path_mis",
       ""},
      {"GoodLampOnTheFloor",
       camera() + rectangle_xml({0, 0, -1}, 3 * x, 3 * y, diffuse_xml(0.5)) +
           mesh_xml("box.obj", light_xml(1)),
       "mis",
       "",
       {box_outward}},
      {"GoodLampJustBelowTheCeiling",
       camera() + floor() + lamp(1.9999) + rectangle_xml({0, 0, 2}, 3 * x, -3 * y, diffuse_xml(0.5)), "mis",
       ""},
      {"GoodTurnedOverTwice",
       camera() + floor() + square_lamp("<scale value=\"-1,-1,1\"/><translate value=\"0,0,2\"/>"),
       "mis",
       "",
       {square}},
      {"GoodManyLamps", camera() + floor() + lamps, "light", ""},
      {"GoodMedium",
       camera() + floor() + point({0, 0, 2}) +
           "<medium type=\"homogeneous\"><color name=\"sigmaA\" value=\"0.1\"/><color name=\"sigmaS\" "
           "value=\"0.1\"/></medium>",
       "path_mis", ""},
      {"GoodNormalsOfBacks", camera({0, -4, -1.5}) + floor(), "normals", ""},
      // Lights.
      {"LightTurnedOver",
       camera() + floor() + square_lamp("<scale value=\"-1,1,1\"/><translate value=\"0,0,2\"/>"),
       "mis",
       "light-turned-over",
       {square}},
      {"LightFacesAway", camera() + floor() + rectangle_xml({0, 0, 2}, 0.5 * x, 0.5 * y, lamp_xml()), "mis",
       "light-faces-nothing"},
      {"LightFacesBacks", camera({0, -4, -2}) + floor() + rectangle_xml({0, 0, -3}, x, y, lamp_xml()), "mis",
       "camera-on-backs light-faces-nothing"},
      {"LightOnBlack", camera({0, -4, 3}) + floor(diffuse_xml(0)) + lamp(), "mis", "light-faces-nothing"},
      {"LightInABox",
       camera({0, -9, 3}) + rectangle_xml({0, 0, -2}, 9 * x, 9 * y, diffuse_xml(0.5)) + lamp() +
           mesh_xml("box.obj", diffuse_xml(0.5)) + sphere_xml({0, 0, 0}, 0.2, lamp_xml()),
       "path_mis",
       "light-faces-nothing",
       {box_outward}},
      {"LightInAClosedRoom",
       camera({0, -29, 3}) + rectangle_xml({0, 0, -6}, 30 * x, 30 * y, diffuse_xml(0.5)) + lamp(20) +
           mesh_xml("room.obj", diffuse_xml(0.5)) + sphere_xml({0, 0, 0}, 0.2, lamp_xml()),
       "path_mis",
       "light-closed-in",
       {box_inward}},
      {"LightShutOut",
       camera() + mesh_xml("room.obj", diffuse_xml(0.5)) + lamp() +
           "<luminaire type=\"constant\"><color name=\"radiance\" value=\"1\"/></luminaire>",
       "path_mis",
       "light-closed-in",
       {box_inward}},
      {"LightBlack", camera() + floor() + rectangle_xml({0, 0, 2}, x, -1 * y, lamp_xml(0)), "mis",
       "light-black"},
      {"PointBehindGlass", camera() + floor() + point({0, 0, 1}) + sphere_xml({0, 0, 1}, 0.3, glass),
       "path_mis", "light-behind-glass"},
      {"LampBehindGlass",
       camera() + floor() + sphere_xml({0, 0, 1}, 0.1, lamp_xml()) + sphere_xml({0, 0, 1}, 0.3, glass),
       "light", "light-behind-glass mirrors-black"},
      {"LampBehindGlassIsFoundByPaths",
       camera() + floor() + sphere_xml({0, 0, 1}, 0.1, lamp_xml()) + sphere_xml({0, 0, 1}, 0.3, glass),
       "path_mats", ""},
      {"PointWithoutLightSamples", camera() + floor() + point({0, 0, 2}), "direct", "light-not-found"},
      {"MirrorsByLightSamples", camera() + floor(mirror) + lamp(), "light",
       "light-behind-glass mirrors-black"},
      {"LightNeverChosen",
       camera() + floor() + row_of_lamps(11) + rectangle_xml({1, 1, 2}, 1e-5 * x, -1e-5 * y, lamp_xml()),
       "mis",
       "light-never-chosen",
       {},
       1,
       "power"},
      // Cameras.
      {"CameraLooksAway", camera({0, -4, 1.5}, {0, -8, 3}) + floor() + lamp(), "mis", "camera-sees-nothing"},
      {"CameraClipsAll",
       camera({0, -4, 1.5}, {0, 0, 0}, "<float name=\"farClip\" value=\"0.5\"/>") + floor() + lamp(), "mis",
       "clipped-all"},
      {"CameraClipsNear",
       camera({0, -4, 1.5}, {0, 0, 0}, "<float name=\"nearClip\" value=\"50\"/>") + floor() + lamp(), "mis",
       "clipped-all"},
      {"CameraClipsMuch",
       camera({0, -4, 1.5}, {0, 0, 0}, "<float name=\"farClip\" value=\"3.5\"/>") + floor() + lamp(), "mis",
       "clipped-much"},
      {"CameraInABall", camera() + floor() + lamp() + sphere_xml({0, -4, 1.5}, 0.3, diffuse_xml(0.5)), "mis",
       "camera-inside"},
      {"CameraInALamp", camera() + floor() + sphere_xml({0, -4, 1.5}, 0.3, lamp_xml()), "mis",
       "camera-inside"},
      {"CameraInADome", camera() + floor() + lamp() + sphere_xml({0, 0, 0}, 50, diffuse_xml(0.5)), "mis",
       "camera-inside"},
      {"CameraOnBacks", camera({0, -2, -3}) + floor() + lamp(), "mis", "camera-on-backs"},
      {"Millimetres",
       camera({0, -4000, 1500}, {0, 0, 0}) + rectangle_xml({0, 0, 0}, 3000 * x, 3000 * y, diffuse_xml(0.5)) +
           point({0, 0, 2000}),
       "light", "large-units"},
      {"BeyondNorisFarClip",
       camera({0, -40000, 15000}, {0, 0, 0}) +
           rectangle_xml({0, 0, 0}, 30000 * x, 30000 * y, diffuse_xml(0.5)) +
           rectangle_xml({0, 0, 20000}, 5000 * x, -5000 * y, lamp_xml()),
       "mis", "clip-default-moved"},
      // Materials.
      {"AlbedoOf255", camera() + floor(diffuse_xml(200)) + lamp(), "mis", "albedo-above-2"},
      {"AlbedoAbove1", camera() + floor(diffuse_xml(1.2)) + lamp(), "mis", "albedo-above-1"},
      {"PhongAbove1", camera() + floor(phong_xml(0.8, 0.8, 30)) + lamp(), "mis", "albedo-above-1"},
      {"TextureAbove1",
       camera() +
           floor("<bsdf type=\"diffuse\"><texture type=\"checkerboard_color\" name=\"albedo\"><color "
                 "name=\"value2\" value=\"255\"/></texture></bsdf>") +
           lamp(),
       "mis", "albedo-above-2"},
      {"LightKeptIn",
       camera({0, 0, 0}, {0, 1, 0}) + mesh_xml("room.obj", diffuse_xml(1) + light_xml(1)),
       "path_mis",
       "light-kept-in",
       {box_inward}},
      // Surfaces in one place.
      {"LampInTheCeiling",
       camera() + floor() + lamp() + rectangle_xml({0, 0, 2}, 3 * x, -3 * y, diffuse_xml(0)), "mis",
       "light-in-surface"},
      {"LampInTheCeilingsBack",
       camera() + floor() + rectangle_xml({0, 0, 2}, 3 * x, 3 * y, diffuse_xml(0.5)) + lamp(), "mis",
       "light-in-surface"},
      {"LampNearlyInTheCeiling",
       camera() + floor() + lamp() + rectangle_xml({0, 0, 2 + 2e-7}, 3 * x, -3 * y, diffuse_xml(0)), "mis",
       "light-in-surface"},
      {"RoundLampInTheCeiling",
       camera() + floor() + rectangle_xml({0, 0, 2}, 3 * x, -3 * y, diffuse_xml(0)) +
           "<shape type=\"disk\"><transform name=\"toWorld\"><scale value=\"0.3,0.3,1\"/><rotate "
           "axis=\"1,0,0\" "
           "angle=\"180\"/><translate value=\"0.2,0.1,2\"/></transform>" +
           lamp_xml() + "</shape>",
       "mis", "light-in-surface"},
      {"BackToBack",
       camera() + floor() + lamp() + rectangle_xml({0.2, 0.1, 2}, 0.5 * x, 0.5 * y, lamp_xml()) +
           rectangle_xml({0, 0, 4}, 3 * x, -3 * y, diffuse_xml(0.5)),
       "mis", "lights-in-one-place"},
      {"BackToBackInOneMesh",
       camera() + floor() + mesh_xml("both.obj", lamp_xml()),
       "mis",
       "lights-in-one-place",
       {{"both.obj", "v -1 -1 2\nv -1 1 2\nv 1 1 2\nv 1 -1 2\nf 1 2 3\nf 1 3 4\nf 1 3 2\nf 1 4 3\n"}}},
      {"LampTwice", camera() + floor() + lamp() + lamp(), "mis", "lights-in-one-place"},
      {"BallTwice",
       camera() + floor() + sphere_xml({0, 0, 2}, 0.5, lamp_xml()) +
           sphere_xml({0, 0, 2}, 0.5, diffuse_xml(0.5)),
       "mis", "light-in-surface"},
      {"GlassOnGlass",
       camera() + floor() + lamp() + rectangle_xml({0, 0, 1}, x, y, glass) +
           rectangle_xml({0.5, 0, 1}, x, y, glass),
       "path_mis", "glass-in-surface"},
      {"BlackBallTwice",
       camera() + floor() + lamp() + sphere_xml({0, 0, 1}, 0.2, "") + sphere_xml({0, 0, 1}, 0.2, ""), "mis",
       "repeated-shape"},
      {"TinyAndFar", camera() + floor() + lamp() + sphere_xml({0, 0, 3e6}, 1, diffuse_xml(0.5)), "mis",
       "rounded-place"},
      {"FloorTwice", camera() + floor() + floor() + lamp(), "mis", "repeated-shape"},
  };
}

class Lint : public testing::TestWithParam<Case> {};

TEST_P(Lint, SaysWhatIsWrong) {
  const Case& c = GetParam();
  const LoadedScene loaded = load_scene_text(c.body, c.files);
  const std::vector<Finding> findings =
      findings_of(loaded, c.integrator, c.samples_per_pixel, c.light_sampler);
  EXPECT_EQ(text_of(findings), c.expected);
  for (const Finding& finding : findings) {
    EXPECT_GT(line_and_column(finding.where).line, 0u) << finding.id;
    EXPECT_FALSE(finding.problem.empty() || finding.remedy.empty()) << finding.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Lint, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST(Lint, FindsFoldedTrianglesInLargeMeshes) {
  // 80 x 80 squares, and one of them from behind too.
  constexpr int n = 80;
  std::string obj;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) obj += fmt::format("v {} {} 2\n", 0.02 * i, 0.02 * k);
  const auto corner = [](int i, int k) { return i * (n + 1) + k + 1; };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      obj += fmt::format("f {} {} {} {}\n", corner(i, k), corner(i, k + 1), corner(i + 1, k + 1),
                         corner(i + 1, k));
  const std::string body = camera() + floor() + mesh_xml("lamp.obj", lamp_xml());
  EXPECT_EQ(text_of(findings_of(load_scene_text(body, {{"lamp.obj", obj}}), "mis")), "");
  obj += fmt::format("f {} {} {}\n", corner(7, 8), corner(8, 9), corner(7, 9));
  EXPECT_EQ(text_of(findings_of(load_scene_text(body, {{"lamp.obj", obj}}), "mis")), "lights-in-one-place");
  const std::string with_ceiling = body + rectangle_xml({0, 0, 2}, 3 * x, -3 * y, diffuse_xml(0.5));
  EXPECT_EQ(text_of(findings_of(load_scene_text(with_ceiling, {{"lamp.obj", obj}}), "mis")),
            "lights-in-one-place light-in-surface");
}

TEST(Lint, NamesBothObjectsWithTheirPlaces) {
  const LoadedScene loaded =
      load_scene_text(camera() + floor() + lamp() + rectangle_xml({0, 0, 2}, 3 * x, -3 * y, diffuse_xml(0)));
  const std::vector<Finding> findings = findings_of(loaded, "mis");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].problem.find("rectangle 2"), std::string::npos) << findings[0].problem;
  EXPECT_NE(findings[0].problem.find("rectangle 3 (line 6)"), std::string::npos) << findings[0].problem;
  EXPECT_EQ(line_and_column(findings[0].where).line, 5u);
}

TEST(Lint, ClipPlanesThatLeaveAnEnvironmentAreSaidToHideShapesOnly) {
  const std::string clipped =
      camera({0, -4, 1.5}, {0, 0, 0}, "<float name=\"farClip\" value=\"0.5\"/>") + floor() + lamp();
  const auto problem_with = [&](const std::string& more) {
    const std::vector<Finding> findings = findings_of(load_scene_text(clipped + more), "mis");
    return findings.empty() ? "" : findings[0].problem;
  };
  EXPECT_NE(problem_with("").find("nothing is seen"), std::string::npos);
  EXPECT_NE(problem_with("<emitter type=\"constant\"/>").find("no shape is seen"), std::string::npos);
}

TEST(Lint, BlackImagesHaveAReason) {
  const auto reason_of = [](const std::string& body, std::string_view integrator) {
    const LoadedScene loaded = load_scene_text(body);
    const IntegratorSettings settings = integrator_from_name(integrator);
    return reason_of_black_image({loaded.scene, loaded.places, settings, 1});
  };
  const auto has = [](const std::string& text, std::string_view part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(reason_of(camera({0, -4, 1.5}, {0, -8, 3}) + floor() + lamp(), "mis"), "looks away");
  has(reason_of(camera() + floor(diffuse_xml(0)) + sphere_xml({0, 0, -3}, 1, diffuse_xml(0.5)) +
                    rectangle_xml({0, 0, -1}, x, -1 * y, lamp_xml()),
                "mis"),
      "all that is seen is black, such as the rectangle 1");
  has(reason_of(camera() + floor() + sphere_xml({0, 0, -3}, 1, diffuse_xml(0.5)) +
                    rectangle_xml({0, 0, -1}, x, -1 * y, lamp_xml()),
                "mis"),
      "no light reaches what is seen");
  has(reason_of(camera() + floor() + sphere_xml({0, 0, 2}, 0.001, lamp_xml()), "direct"),
      "direct has not found it in 1 samples");
  has(reason_of(camera() + floor() + lamp(), "ao"), "knows no lights");
}

TEST(Lint, CountsPixelsWhoseErrorIsNotZero) {
  const LoadedScene loaded =
      load_scene_text(camera({0, 0, 3}, {0, 0, 0}) + floor() + sphere_xml({0, 0, 4}, 0.01, lamp_xml()));
  const IntegratorSettings settings = integrator_from_name("direct");
  std::vector<Pixel> dark;
  for (int k = 0; k < 32; ++k) dark.push_back({k, 16});
  EXPECT_EQ(count_lit_pixels({loaded.scene, loaded.places, settings, 1}, dark), 32u);
  const LoadedScene shadowed =
      load_scene_text(camera({0, 0, 3}, {0, 0, 0}) + floor() + sphere_xml({0, 0, 4}, 0.01, lamp_xml()) +
                      rectangle_xml({0, 0, 3.5}, 3 * x, 3 * y, diffuse_xml(0)));
  EXPECT_EQ(count_lit_pixels({shadowed.scene, shadowed.places, settings, 1}, dark), 0u);
}

/// Doubtful and wrong ones, of all scenes below a folder that can be loaded.
void expect_no_false_word(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    try {
      const SceneDesc description = read_nori_xml(entry.path());
      const LoadedScene loaded = load_scene(description);
      std::vector<UnreadKey> unread;
      const IntegratorSettings settings =
          loaded.integrator.family.empty() ? IntegratorSettings{}
                                           : make_integrator(loaded.integrator, description.dialect, unread);
      for (const Finding& finding :
           lint({loaded.scene, loaded.places, settings, loaded.samples_per_pixel}, thorough))
        EXPECT_EQ(finding.severity, Severity::harmless)
            << format_message(finding.where, finding.problem, finding.id);
    } catch (const InputError&) {  // Tests, other programs' scenes, files that are bad on purpose.
    }
  }
}

TEST(Lint, GoodScenesGetNoFalseWord) { expect_no_false_word(ETENDUE_SOURCE_DIR "/scenes"); }

TEST(Lint, ScenesOfOthersGetNoFalseWord) {
  if (!std::filesystem::exists(data_folder())) GTEST_SKIP() << "no " << data_folder();
  for (const auto& entry : std::filesystem::directory_iterator(data_folder()))
    if (entry.path().filename().string().starts_with("nori-")) expect_no_false_word(entry.path());
}

TEST(Lint, ThePageListsTheChecks) {
  const std::string page = read_file(ETENDUE_SOURCE_DIR "/docs/lint.md");
  std::set<std::string> listed;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| `")) listed.insert(line.substr(0, line.find('|', line.find('|', 1) + 1) + 1));
  std::set<std::string> there;
  for (const Check& check : lint_checks())
    there.insert(fmt::format("| `{}` | {} |", check.id, severity_name(check.severity)));
  EXPECT_EQ(listed, there);
}

}  // namespace
}  // namespace etendue::test
