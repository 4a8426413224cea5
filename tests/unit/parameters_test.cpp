#include "scenefile/parameters.h"

#include "support/error_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>

namespace etendue {
namespace {

using testing::HasSubstr;
using Type = Parameter::Type;

const Plugin plugin{"bsdf",
                    "phong",
                    "a test",
                    {{"kd", Type::color, "0.5", "", "diffuse reflectance"},
                     {"ks", Type::color, "0.1, 0.2, 0.3", "", "specular reflectance"},
                     {"n", Type::real, "20", "", "exponent"},
                     {"count", Type::integer, "4", "", "a count"},
                     {"flag", Type::boolean, "true", "", "a flag"},
                     {"label", Type::text, "none", "", "a label"},
                     {"center", Type::point, "1 2 3", "m", "a point"},
                     {"axis", Type::vector, "0,0,1", "", "a vector"},
                     {"toWorld", Type::transform, "identity", "", "a transform"},
                     {"limit", Type::real, "", "", "without a default"}},
                    {}};

class ParametersTest : public testing::Test {
 protected:
  Property property(const std::string& name, const std::string& tag, Property::Value value) const {
    const auto source = std::make_shared<SourceFile>(SourceFile{"s.xml", name + " " + tag});
    return {name, tag, std::move(value), {source, 0, name.size()}, {source, name.size() + 1, tag.size()}};
  }
  Object object(std::vector<Property> properties) const {
    const Location where{std::make_shared<SourceFile>(SourceFile{"s.xml", "bsdf"}), 0, 4};
    return {"bsdf", "phong", "", where, where, std::move(properties), {}};
  }
  std::string error(std::vector<Property> properties, const Plugin& accepted = plugin) const {
    std::vector<UnreadKey> unread;
    const Object stated = object(std::move(properties));
    return test::error_of([&] { Parameters(stated, accepted, unread); });
  }
  std::vector<UnreadKey> unread_;
};

TEST_F(ParametersTest, FillsDefaultsOfEveryType) {
  const Object empty = object({});
  const Parameters p(empty, plugin, unread_);
  EXPECT_EQ(p.color("kd"), (Colorf{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(p.color("ks"), (Colorf{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(p.real("n"), 20);
  EXPECT_EQ(p.integer("count"), 4);
  EXPECT_TRUE(p.boolean("flag"));
  EXPECT_EQ(p.text("label"), "none");
  EXPECT_EQ(p.point("center"), (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(p.vector("axis"), (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(p.transform("toWorld"), Transform{});
  EXPECT_TRUE(p.has("n"));
  EXPECT_FALSE(p.is_stated("n"));
  EXPECT_FALSE(p.has("limit"));
  EXPECT_EQ(p.location("n").source, empty.location.source);
  EXPECT_THROW(p.real("limit"), std::logic_error);
  EXPECT_TRUE(unread_.empty());
}

TEST_F(ParametersTest, StatedValuesReplaceDefaults) {
  const Object stated = object({property("n", "float", 7.5), property("limit", "float", 2.0)});
  const Parameters p(stated, plugin, unread_);
  EXPECT_EQ(p.real("n"), 7.5);
  EXPECT_TRUE(p.is_stated("n"));
  EXPECT_EQ(p.real("limit"), 2);
  EXPECT_EQ(p.location("n").offset, 2u);
  EXPECT_EQ(&p.object(), &stated);
}

TEST_F(ParametersTest, AcceptsTheConversionsThatLoseNothing) {
  const Object stated =
      object({property("n", "integer", 7), property("kd", "float", 0.25), property("ks", "integer", 1),
              property("center", "vector", Vec3<double>{4, 5, 6}),
              property("axis", "point", Vec3<double>{7, 8, 9})});
  const Parameters p(stated, plugin, unread_);
  EXPECT_EQ(p.real("n"), 7);
  EXPECT_EQ(p.color("kd"), (Colorf{0.25f, 0.25f, 0.25f}));
  EXPECT_EQ(p.color("ks"), (Colorf{1, 1, 1}));
  EXPECT_EQ(p.point("center"), (Vec3<double>{4, 5, 6}));
  EXPECT_EQ(p.vector("axis"), (Vec3<double>{7, 8, 9}));
}

TEST_F(ParametersTest, RefusesOtherTypes) {
  EXPECT_EQ(error({property("n", "string", std::string("7"))}),
            "s.xml:1:3: 'n' of bsdf 'phong' must be a number, not a <string>\n"
            "  1 | n string\n"
            "    |   ^~~~~~\n"
            "write <float name=\"n\" value=\"...\"/>");
  EXPECT_NE(error({property("count", "float", 7.0)}), "");
  EXPECT_NE(error({property("flag", "integer", 1)}), "");
  EXPECT_NE(error({property("label", "float", 1.0)}), "");
  EXPECT_NE(error({property("kd", "vector", Vec3<double>{1, 1, 1})}), "");
  EXPECT_NE(error({property("center", "color", Colorf{1, 1, 1})}), "");
  EXPECT_NE(error({property("toWorld", "float", 1.0)}), "");
  EXPECT_THAT(error({property("center", "point", Vec2<double>{1, 1})}),
              HasSubstr("needs 3 numbers, found 2"));
  EXPECT_THAT(error({property("kd", "float", 1e39)}), HasSubstr("out of range"));
}

TEST_F(ParametersTest, ReportsUnreadKeysWithTheNearestName) {
  const Object stated = object({property("cuont", "integer", 7), property("n", "float", 1.0)});
  const Parameters p(stated, plugin, unread_);
  ASSERT_EQ(unread_.size(), 1u);
  EXPECT_THAT(unread_[0].message, HasSubstr("s.xml:1:1: unknown key 'cuont' of bsdf 'phong'"));
  EXPECT_THAT(unread_[0].message, HasSubstr("did you mean 'count'? known: count,"));
}

TEST_F(ParametersTest, DemandsRequiredOnesAndEachOnce) {
  Plugin strict = plugin;
  strict.parameters[9].is_required = true;
  EXPECT_EQ(error({}, strict),
            "s.xml:1:1: bsdf 'phong' lacks 'limit': without a default\n"
            "  1 | bsdf\n"
            "    | ^~~~\n"
            "write <float name=\"limit\" value=\"...\"/>");
  EXPECT_EQ(error({property("limit", "float", 1.0)}, strict), "");
  EXPECT_THAT(error({property("n", "float", 1.0), property("n", "float", 1.0)}),
              HasSubstr("'n' of bsdf 'phong' is stated twice"));
}

/// Two parameters that take textures, one of them required, one of two numbers, and one of neither kind.
const Plugin textured{"bsdf",
                      "cloth",
                      "a test",
                      {{"albedo", Type::color, "", "", "reflectance", true, true},
                       {"roughness", Type::color, "0.1", "", "roughness", false, true},
                       {"delta", Type::point2, "0, 0.5", "", "a place"},
                       {"n", Type::real, "20", "", "exponent"}},
                      {}};

class Textures : public ParametersTest {
 protected:
  Object with(std::vector<Property> properties, std::vector<std::string> texture_names) const {
    Object made = object(std::move(properties));
    for (const std::string& name : texture_names) {
      const Location where{std::make_shared<SourceFile>(SourceFile{"s.xml", "texture " + name}), 0, 7};
      made.children.push_back({"texture", "bitmap", name, where, where, {}, {}});
    }
    return made;
  }
  std::string error_of(const Object& stated, const Plugin& accepted = textured) const {
    std::vector<UnreadKey> unread;
    return test::error_of([&] { Parameters(stated, accepted, unread); });
  }
};

TEST_F(Textures, StandForAParameterRequiredOrNot) {
  const Object stated = with({}, {"roughness", "albedo"});
  const Parameters p(stated, textured, unread_);
  EXPECT_EQ(p.texture("roughness"), &stated.children[0]);
  EXPECT_EQ(p.texture("albedo"), &stated.children[1]);
  EXPECT_EQ(p.texture("n"), nullptr);
  EXPECT_TRUE(p.is_stated("albedo"));
  EXPECT_FALSE(p.has("roughness")) << "a default beside a texture could be taken for the value";
  EXPECT_THROW(p.color("roughness"), std::logic_error);
  EXPECT_EQ(p.location("albedo").source, stated.children[1].location.source);
  EXPECT_TRUE(unread_.empty());
}

TEST_F(Textures, AreNoneWhereAValueIsStated) {
  const Object stated = with({property("albedo", "color", Colorf{1, 0, 0})}, {});
  const Parameters p(stated, textured, unread_);
  EXPECT_EQ(p.texture("albedo"), nullptr);
  EXPECT_EQ(p.color("albedo"), (Colorf{1, 0, 0}));
  EXPECT_EQ(p.color("roughness"), (Colorf{0.1f, 0.1f, 0.1f}));
}

TEST_F(Textures, AreRefusedWhereTheyStandForNothing) {
  EXPECT_EQ(error_of(with({}, {"albdeo"})),
            "s.xml:1:1: no parameter 'albdeo' of bsdf 'phong' takes a texture\n"
            "  1 | texture albdeo\n"
            "    | ^~~~~~~\n"
            "did you mean 'albedo'? known: albedo, roughness");
  EXPECT_THAT(error_of(with({}, {"n"})), HasSubstr("no parameter 'n' of bsdf 'phong' takes a texture"));
  EXPECT_THAT(error_of(with({}, {""})), HasSubstr("write <texture type=\"bitmap\" name=\"albedo\">"));
  EXPECT_THAT(error_of(with({}, {"kd"}), plugin), HasSubstr("<texture> has no place inside <bsdf>"));
}

TEST_F(Textures, AreRefusedBesideAnotherStatement) {
  EXPECT_THAT(error_of(with({}, {"albedo", "albedo"})), HasSubstr("a second texture for 'albedo'"));
  EXPECT_THAT(error_of(with({property("albedo", "color", Colorf{1, 0, 0})}, {"albedo"})),
              HasSubstr("'albedo' of bsdf 'phong' is stated twice: as a value and as a texture"));
}

TEST_F(Textures, TwoNumbersAreAPoint2) {
  const Object stated =
      with({property("delta", "vector", Vec2<double>{3, 4}), property("albedo", "float", 1.0)}, {});
  EXPECT_EQ(Parameters(stated, textured, unread_).point2("delta"), (Vec2<double>{3, 4}));
  const Object defaulted = with({property("albedo", "float", 1.0)}, {});
  EXPECT_EQ(Parameters(defaulted, textured, unread_).point2("delta"), (Vec2<double>{0, 0.5}));
  EXPECT_THAT(error_of(with({property("delta", "point", Vec3<double>{3, 4, 5})}, {"albedo"})),
              HasSubstr("needs 2 numbers, found 3"));
  EXPECT_NE(error_of(with({property("delta", "float", 3.0)}, {"albedo"})), "");
}

TEST_F(ParametersTest, AWrongDefaultIsAFaultOfTheProgram) {
  Plugin wrong = plugin;
  wrong.parameters[2].default_value = "20x";
  EXPECT_THROW(error({}, wrong), std::logic_error);
}

TEST_F(ParametersTest, RefusesNegativeOrInfiniteColours) {
  const auto checked = [&](const Colorf& color) {
    const Object stated = object({property("kd", "color", color)});
    return nonnegative_color(Parameters(stated, plugin, unread_), "kd");
  };
  EXPECT_EQ(checked({0, 2, 1}), (Colorf{0, 2, 1}));
  EXPECT_THROW(checked({0, -1e-6f, 1}), InputError);
  EXPECT_THROW(checked({0, 0, HUGE_VALF}), InputError);
  EXPECT_THROW(checked({std::nanf(""), 0, 0}), InputError);
}

TEST_F(ParametersTest, NamesThePluginsNearestToAnUnknownOne) {
  Object wrong = object({});
  wrong.type = "phnog";
  EXPECT_STREQ(unknown_plugin(wrong, {plugin}).what(),
               "s.xml:1:1: unknown bsdf 'phnog'\n  1 | bsdf\n    | ^~~~\ndid you mean 'phong'? known: phong");
  EXPECT_STREQ(unknown_plugin("integrator", "x", {}).what(), "unknown integrator 'x'\nknown: none");
}

}  // namespace
}  // namespace etendue
