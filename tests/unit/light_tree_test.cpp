// The light tree: clusters hold what they say, and whatever reaches a receiver can be chosen for it, by a
// walk and by a cut.
//
// Seen to fail when: importance has no slack, or takes the light's or the receiver's normal the wrong way
// round; a cluster of a cut whose share rounds to 0 keeps none; a far facet's radius is measured to one
// corner; a cluster that no pilot sees keeps no share; what is seen of a cluster does not count for the one
// around it; ends of shares are rounded by more than the smaller of both; positions are not the inverse.
#include "lightsampler/light_tree.h"

#include "lightsampler/make_light_cut.h"
#include "lightsampler/tree_lights.h"
#include "random_lights.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace etendue {
namespace {

struct TreeCase {
  const char* name;
  Lights lights;
};

/// Rectangles one on the other.
Lights at_one_place(int count) {
  Lights lights;
  for (int k = 0; k < count; ++k)
    lights.add<RectangleLights>({1, 1, 1}, "", Vec3f{0, 0, 2}, Vec3f{0, 1, 0}, Vec3f{1, 0, 0});
  return lights;
}

Lights with_radiance(float radiance, int count) {
  Lights lights;
  for (int k = 0; k < count; ++k)
    lights.add<RectangleLights>({radiance, radiance, radiance}, "", Vec3f{float(k), 0, 2}, Vec3f{0, 1, 0},
                                Vec3f{1, 0, 0});
  return lights;
}

Lights triangles(int count) {
  RandomPlaces random(4);
  Lights lights;
  add_triangles(lights, random, count, {.extent = 2, .size = 0.01f}, 1);
  return lights;
}

Lights swarm(std::uint32_t seed, const LightSwarm& places) {
  RandomPlaces random(seed);
  return random_lights(random, places);
}

std::vector<TreeCase> tree_cases() {
  std::vector<TreeCase> cases;
  cases.push_back({"one facet", at_one_place(1)});
  cases.push_back({"three facets", triangles(3)});
  cases.push_back({"all at one place", at_one_place(100)});
  cases.push_back({"without power", with_radiance(0, 5)});
  cases.push_back({"all kinds", swarm(1, {.count = 300})});
  cases.push_back({"far from the origin",
                   swarm(2, {.count = 300, .extent = 1e-2f, .size = 1e-3f, .center = {900, -2e3f, 40}})});
  cases.push_back({"tiny", swarm(3, {.count = 200, .extent = 1e-6f, .size = 1e-7f})});
  cases.push_back({"huge", swarm(4, {.count = 200, .extent = 1e6f, .size = 1e4f})});
  cases.push_back({"one reaching through all", swarm(5, {.count = 50, .extent = 0.1f, .size = 3})});
  cases.push_back({"stronger than floats can hold together", with_radiance(2e38f, 30)});
  cases.push_back({"70,000 facets", triangles(70000)});
  return cases;
}

TEST(LightTree, HasEachFacetInOnePlaceAndOneLeaf) {
  for (const TreeCase& c : tree_cases()) {
    const LightTree tree(c.lights);
    std::vector<int> seen(std::size_t(tree.facet_count()));
    std::int32_t facets = 0;
    for (std::int32_t light = 0; light < c.lights.count(); ++light)
      for (std::int32_t facet = 0; facet < c.lights.facet_count(light); ++facet, ++facets) {
        const std::int32_t place = tree.place_of<float>(light, facet);
        ASSERT_TRUE(place >= 0 && place < tree.facet_count()) << c.name;
        ++seen[std::size_t(place)];
        EXPECT_TRUE(tree.facets()[place].light == light && tree.facets()[place].facet == facet) << c.name;
      }
    EXPECT_EQ(facets, tree.facet_count()) << c.name;
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; })) << c.name;

    const int most_in_leaf = facets < (1 << 16) ? 1 : 4;
    std::int32_t in_leaves = 0;
    for (std::int32_t k = 0; k < tree.cluster_count(); ++k) {
      const LightCluster& cluster = tree.clusters()[k];
      if (cluster.first_child == 0) {
        EXPECT_TRUE(cluster.end > cluster.begin && cluster.end - cluster.begin <= most_in_leaf) << c.name;
        for (std::int32_t place = cluster.begin; place < cluster.end; ++place, ++in_leaves)
          EXPECT_EQ(tree.leaves()[place], k) << c.name;
        continue;
      }
      const LightCluster &left = tree.clusters()[cluster.first_child], &right = (&left)[1];
      EXPECT_TRUE(left.parent == k && right.parent == k) << c.name;
      EXPECT_TRUE(left.begin == cluster.begin && left.end == right.begin && right.end == cluster.end)
          << c.name;
    }
    EXPECT_EQ(in_leaves, facets) << c.name;
  }
}

TEST(LightTree, ClustersHoldWhatTheySay) {
  for (const TreeCase& c : tree_cases()) {
    const LightTree tree(c.lights);
    double total = 0;
    for (std::int32_t light = 0; light < c.lights.count(); ++light) total += c.lights.power(light);
    const std::int32_t step = tree.facet_count() > 10000 ? 7 : 1;
    for (std::int32_t place = 0; place < tree.facet_count(); place += step) {
      const LightFacet& id = tree.facets()[place];
      const LightBounds bounds = *c.lights.facet_bounds(id.light, id.facet);
      const std::int32_t share = tree.shares()[place + 1] - tree.shares()[place];
      EXPECT_EQ(share > 0, total == 0 || c.lights.facet_power(id.light, id.facet) > 0) << c.name;
      for (std::int32_t k = tree.leaves()[place];; k = tree.clusters()[k].parent) {
        const LightCluster& cluster = tree.clusters()[k];
        ASSERT_TRUE(cluster.begin <= place && place < cluster.end) << c.name;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3<double> at{corner & 1 ? bounds.box.low.x : bounds.box.high.x,
                                corner & 2 ? bounds.box.low.y : bounds.box.high.y,
                                corner & 4 ? bounds.box.low.z : bounds.box.high.z};
          ASSERT_LE(length_sq(at - widen(cluster.center)), double(cluster.radius_sq)) << c.name;
        }
        if (cluster.cos_normals > -1) {
          ASSERT_GE(bounds.cos_emission, 0) << c.name << ": shines beyond a right angle";
          const double between =
              std::acos(std::clamp(dot(widen(bounds.axis), widen(cluster.axis)), -1.0, 1.0));
          ASSERT_LE(between + std::acos(double(bounds.cos_normals)),
                    std::acos(double(cluster.cos_normals)) + 1e-3)
              << c.name;
        }
        if (k == 0) break;
      }
    }
    for (std::int32_t k = 0; k < tree.cluster_count() && total > 0; ++k) {
      const LightCluster& cluster = tree.clusters()[k];
      double power = 0;
      for (std::int32_t place = cluster.begin; place < cluster.end; ++place)
        power += c.lights.facet_power(tree.facets()[place].light, tree.facets()[place].facet) / total;
      // No facet with any power has less than 2^-28 of all.
      const double least_shares = (cluster.end - cluster.begin) * 0x1p-28;
      ASSERT_NEAR(cluster.power, power, 1e-5 * power + least_shares) << c.name;
    }
  }
}

// Whatever can reach a receiver can be chosen.

/// Whether this point of a facet sends anything to the receiver that it scatters: with nothing between.
bool reaches(const Lights& lights, const LightFacet& id, const Receiver<float>& receiver,
             const Vec2<std::uint32_t>& u) {
  const LightSample<float> sample = lights.sample<float>(id.light, 1, receiver, u, true, id.facet);
  const float arriving = luminance(sample.radiance_over_pdf);
  if (!sample.is_there || !(arriving > 0) || std::isinf(arriving)) return false;
  const float cosine = dot(sample.wi, receiver.ns);
  return receiver.lit_sides == lit_side::medium || cosine > 0 ||
         (receiver.lit_sides == (lit_side::front | lit_side::back) && cosine < 0);
}

/// The least product of both cosines with which any cluster around the facet is weighed.
double least_cosines(const LightTree& tree, std::int32_t place, const Receiver<float>& receiver) {
  double least = 1;
  for (std::int32_t k = tree.leaves()[place];; k = tree.clusters()[k].parent) {
    const LightCluster& cluster = tree.clusters()[k];
    const double distance_sq = length_sq(widen(cluster.center) - widen(receiver.position));
    const double nearness = cluster.power / std::max(distance_sq, 0.25 * cluster.radius_sq);
    least = std::min(least, importance(broadcast<float>(cluster), receiver).value / nearness);
    if (k == 0) return least;
  }
}

/// Places that are hard for a facet: touching it, in its plane, with a horizon through it, far away.
Receiver<float> hard_receiver(RandomPlaces& random, const LightSwarm& swarm, const LightBounds& bounds) {
  const auto between = [&](float low, float high) { return low + (high - low) * random.uniform(0, 1); };
  const Vec3f on{between(bounds.box.low.x, bounds.box.high.x), between(bounds.box.low.y, bounds.box.high.y),
                 between(bounds.box.low.z, bounds.box.high.z)};
  Vec3f away = random.direction();
  float distance = swarm.size * random.magnitude(-6, 1);
  switch (random.below(4)) {
    case 0:
      distance = swarm.extent * random.magnitude(0, 6);
      break;
    case 1:  // All but in the plane of its surface.
      away = normalize(away - bounds.axis * (dot(away, bounds.axis) - random.magnitude(-6, -1)));
      break;
    default:
      break;
  }
  const Vec3f position =
      random.below(8) == 0 ? swarm.center + random.in_cube(swarm.extent) : on + away * distance;
  Vec3f normal = random.direction();
  if (random.below(2) == 0) {  // The horizon passes close by.
    const Vec3f across = normal - away * dot(normal, away);
    if (length_sq(across) > 1e-6f)
      normal = normalize(normalize(across) + away * random.uniform(-1, 1) * random.magnitude(-6, 0));
  }
  constexpr std::int32_t sides[]{lit_side::front, lit_side::front, lit_side::front | lit_side::back,
                                 lit_side::medium};
  return {position, normal, normal, sides[random.below(4)]};
}

/// Nearby, more or less.
Receiver<float> moved(RandomPlaces& random, Receiver<float> receiver, const Vec3f& towards) {
  const float step = random.magnitude(-7, 0);
  if (random.below(2) == 0)
    receiver.position = receiver.position + random.direction() * (step * length(towards - receiver.position));
  else
    receiver.ns = receiver.ng = normalize(receiver.ns + random.direction() * step);
  return receiver;
}

TEST(LightTree, CanChooseWhateverReachesAReceiver) {
  RandomPlaces random(11);
  // Each of both cosines keeps half of its slack at the least.
  constexpr double least_allowed = 0.25e-6;
  double least_found = 1;
  int reached = 0;
  for (int scene = 0; scene < 80; ++scene) {
    const float extent = random.magnitude(-6, 6);
    const LightSwarm places{.count = 1 + random.below(scene % 4 == 0 ? 200 : 12),
                            .extent = extent,
                            .size = extent * random.magnitude(-3, 1),
                            .center = random.in_cube(extent * (scene % 3 == 0 ? 4 : 0))};
    const Lights lights = random_lights(random, places);
    const TreeLights sampler(lights);
    const LightTree& tree = sampler.tree();
    for (int start = 0; start < 60; ++start) {
      const std::int32_t place = random.below(tree.facet_count());
      const LightFacet id = tree.facets()[place];
      const LightBounds bounds = *lights.facet_bounds(id.light, id.facet);
      Receiver<float> receiver = hard_receiver(random, places, bounds);
      double cosines = 2;
      for (int step = 0; step < 60; ++step) {
        const Receiver<float> next = cosines < 2 ? moved(random, receiver, bounds.box.low) : receiver;
        constexpr std::uint32_t edges[]{0, 0x80000000, 0xffffffff};
        const Vec2<std::uint32_t> u =
            random.below(2) == 0 ? Vec2<std::uint32_t>{edges[random.below(3)], edges[random.below(3)]}
                                 : Vec2<std::uint32_t>{random.word(), random.word()};
        if (!reaches(lights, id, next, u)) continue;
        ++reached;
        ASSERT_GT((sampler.pmf<float>(next, id.light, id.facet)), 0)
            << "scene " << scene << ", start " << start;
        const double found = least_cosines(tree, place, next);
        ASSERT_GT(found, least_allowed) << "scene " << scene << ", start " << start;
        least_found = std::min(least_found, found);
        if (found > cosines) continue;
        cosines = found;
        receiver = next;
      }
    }
  }
  EXPECT_GT(reached, 20000);
  EXPECT_LT(least_found, 1e-4) << "the search is too weak to find where it is close";
}

TEST(LightTree, ProbabilitiesAddUpToOneOrToNothing) {
  RandomPlaces random(12);
  for (const TreeCase& c : tree_cases()) {
    const TreeLights sampler(c.lights);
    const LightTree& tree = sampler.tree();
    for (int k = 0; k < (tree.facet_count() > 1000 ? 1 : 20); ++k) {
      const LightBounds bounds = *c.lights.facet_bounds(0, 0);
      const Receiver<float> receiver = hard_receiver(random, {.extent = 1, .size = 0.1f}, bounds);
      double sum = 0;
      for (std::int32_t place = 0; place < tree.facet_count(); ++place)
        sum += sampler.pmf<float>(receiver, tree.facets()[place].light, tree.facets()[place].facet);
      EXPECT_LT(sum, 1 + 1e-5) << c.name;
      if (receiver.lit_sides == lit_side::medium) {
        EXPECT_NEAR(sum, tree.facet_count() == 1 ? 1 : sum, 1e-5) << c.name;
      }
    }
  }
}

// Cuts.

/// A pilot sees the facets of which this is true.
using Sees = bool (*)(const LightChoice<float>& choice);
constexpr Sees sees_all = [](const LightChoice<float>&) { return true; };
constexpr Sees sees_nothing = [](const LightChoice<float>&) { return false; };
constexpr Sees sees_every_third = [](const LightChoice<float>& c) { return (c.light + c.facet) % 3 == 0; };

LightCut cut_with_sight(const LightTree& tree, const std::vector<Receiver<float>>& pilots,
                        const std::array<bool, light_cut_pilots>& is_lit, Sees sees) {
  return make_light_cut<float>(
      tree, pilots.data(), is_lit.data(),
      [](int p, const Importance<float>&) { return 1.0f + 0.1f * float(p); },
      [&](int, const LightChoice<float>& choice, std::uint32_t) {
        return SeenLight<float>{true, sees(choice)};
      });
}

/// A cut for pilots at random, of which some are not lit.
struct MadeCut {
  LightCuts cuts;
  Receiver<float> receiver{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::front};

  MadeCut(const LightTree& tree, RandomPlaces& random, const Vec3f& center, float extent, int lit,
          Sees sees) {
    cuts.take_tiles({7, 3}, nullptr, [&](std::int32_t) {
      std::vector<Receiver<float>> pilots(light_cut_pilots);
      std::array<bool, light_cut_pilots> is_lit{};
      for (int k = 0; k < light_cut_pilots; ++k) {
        const Vec3f normal = random.direction();
        pilots[std::size_t(k)] = {center + random.in_cube(extent), normal, normal, lit_side::front};
        is_lit[std::size_t(k)] = k < lit;
      }
      return cut_with_sight(tree, pilots, is_lit, sees);
    });
    receiver.cuts = &cuts;
    receiver.cut = 1;
  }
};

TEST(LightCuts, CanChooseWhateverHasPower) {
  RandomPlaces random(13);
  for (const TreeCase& c : tree_cases()) {
    const TreeLights sampler(c.lights);
    const LightTree& tree = sampler.tree();
    const LightCluster& root = tree.clusters()[0];
    double total = 0;
    for (std::int32_t light = 0; light < c.lights.count(); ++light) total += c.lights.power(light);
    for (const int lit : {0, 1, light_cut_pilots})
      for (const Sees sees : {sees_all, sees_nothing, sees_every_third}) {
        const MadeCut cut(tree, random, root.center, 2 * std::sqrt(root.radius_sq), lit, sees);
        double sum = 0;
        for (std::int32_t place = 0; place < tree.facet_count(); ++place) {
          const LightFacet& id = tree.facets()[place];
          const float pmf = sampler.pmf<float>(cut.receiver, id.light, id.facet);
          EXPECT_EQ(pmf > 0, total == 0 || c.lights.facet_power(id.light, id.facet) > 0) << c.name;
          sum += pmf;
        }
        EXPECT_NEAR(sum, 1, 1e-5) << c.name << ", " << lit << " pilots lit";
      }
  }
}

/// pmf of each of some lights that are one facet each, by a cut for pilots below them.
std::vector<double> pmf_below(const Lights& lights, Sees sees) {
  const TreeLights sampler(lights);
  const std::vector<Receiver<float>> pilots(light_cut_pilots,
                                            {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::front});
  std::array<bool, light_cut_pilots> is_lit;
  is_lit.fill(true);
  LightCuts cuts;
  cuts.take_tiles({0}, nullptr,
                  [&](std::int32_t) { return cut_with_sight(sampler.tree(), pilots, is_lit, sees); });
  Receiver<float> receiver = pilots[0];
  receiver.cuts = &cuts;
  std::vector<double> pmf;
  for (std::int32_t light = 0; light < lights.count(); ++light)
    pmf.push_back(sampler.pmf<float>(receiver, light, 0));
  return pmf;
}

TEST(LightCuts, ChooseLessWhatPilotsHardlySee) {
  const Lights lights = at_one_place(24);
  const std::vector<double> with_all = pmf_below(lights, sees_all),
                            with_none = pmf_below(lights, sees_nothing),
                            with_some = pmf_below(lights, sees_every_third);
  for (std::size_t k = 0; k < 24; ++k) {
    EXPECT_NEAR(with_all[k], 1.0 / 24, 0.5 / 24);
    EXPECT_NEAR(with_none[k], with_all[k], 1e-6) << "all hidden alike";
    EXPECT_EQ(with_some[k] > with_all[k], k % 3 == 0);
    EXPECT_GT(with_some[k], 0.05 / 24) << "the share by power at the least";
  }
}

TEST(ClusterVisibility, TakesLittleSeenClustersForWhatStandsAround) {
  // A root with two children, the second of which has two more.
  const std::vector<CutNode> nodes{{0, 0}, {1, 0}, {2, 0}, {3, 2}, {4, 2}};
  ClusterVisibility none(nodes);
  for (const double mean : none.means()) EXPECT_EQ(mean, 1);
  ClusterVisibility some(nodes);
  for (int k = 0; k < 6; ++k) some.count(1, true);
  EXPECT_FALSE(some.has_met_something());
  for (const double mean : some.means()) EXPECT_EQ(mean, 1);
  for (int k = 0; k < 4; ++k) some.count(3, false);
  EXPECT_TRUE(some.has_met_something());
  const double root = (6 + 2.0) / (10 + 2), right = 2 * root / (4 + 2);
  const std::vector<double> expected{root, (6 + 2 * root) / (6 + 2), right, 2 * right / (4 + 2), right};
  for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_NEAR(some.means()[k], expected[k], 1e-12) << k;
}

TEST(LightCuts, HaveRoundSharesAndSeenClustersFirst) {
  const std::vector<CutCluster> clusters{{0, 0.11, 1},   {3, 0.05, 0.1}, {4, 0.17, 1},  {9, 0.02, 0},
                                         {10, 0.3, 0.6}, {11, 0, 1},     {12, 1e-8, 0}, {13, 0.35, 1}};
  const LightCut cut = light_cut_of(clusters, 20);
  const std::vector<std::int32_t> order{0, 2, 4, 5, 7, 1, 3, 6};
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    EXPECT_EQ(cut.clusters[k], order[k]);
    EXPECT_EQ(cut.positions[std::size_t(order[k])], std::int32_t(k));
    EXPECT_EQ(cut.places[k], clusters[k].begin);
    const double share = (cut.shares[k + 1] - cut.shares[k]) * 0x1p-30,
                 weight = clusters[std::size_t(order[k])].weight;
    EXPECT_GE(share, 0.5 * weight - 0x1p-30) << k;
    EXPECT_LE(share, 1.5 * weight + 0x1p-30) << k;
    EXPECT_EQ(share > 0, weight > 0) << k;
  }
  EXPECT_EQ(cut.places[clusters.size()], 20);
  EXPECT_EQ(cut.shares[LightCut::most_clusters], 1 << 30);
  for (const std::size_t k : {1u, 2u}) EXPECT_EQ(cut.shares[k] % (1 << 25), 0) << "a multiple of 1/32";
}

TEST(LightCuts, AreMadeOnceWhereTheyAreKept) {
  const Lights lights = swarm(6, {.count = 20});
  const LightTree tree(lights);
  LightCutStore store(10);
  LightCuts cuts, others;
  const Receiver<float> pilot{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::front};
  const std::array<bool, light_cut_pilots> is_lit{};
  int made = 0;
  const auto take = [&](LightCuts& of, const std::vector<std::int32_t>& tiles) {
    of.take_tiles(tiles, &store, [&](std::int32_t) {
      const std::vector<Receiver<float>> pilots(light_cut_pilots, pilot);
      ++made;
      return cut_with_sight(tree, pilots, is_lit, sees_all);
    });
  };
  take(cuts, {1, 2});
  take(cuts, {2, 3});
  take(others, {3, 1});
  EXPECT_EQ(made, 3);
  take(others, {12});
  take(cuts, {12});
  EXPECT_EQ(made, 5) << "more than are kept";
}

}  // namespace
}  // namespace etendue
