// Changes of a world during a year: permanent changes of poles, seasons, building sites.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/world/World.h"
#include "support/Worlds.h"

namespace polemcl::test_world_year {
namespace {

using namespace polemcl::sim;

WorldOptions street(std::uint64_t seed, int day, double length = 400) {
  WorldOptions options = tests::streetOptions(seed, day, length);
  options.removedShare = options.addedShare = 0;
  return options;
}

double distance(const BuildingSite& site, double x, double y) {
  double best = 1e9;
  for (const auto& place : site.kerb) best = std::min(best, (place - Eigen::Vector2d(x, y)).norm());
  return best;
}

TEST(WorldYear, PolesThatGoStayGoneAndThoseThatComeStay) {
  std::map<std::uint32_t, TruePole> before, everGone;
  std::size_t gone = 0, come = 0;
  for (int day = 0; day <= 720; day += 40) {
    WorldOptions options = street(31, day);
    options.replacedPerYear = 0.3;
    const auto today = tests::polesById(makeWorld(options));
    for (const auto& [id, pole] : before) {
      const auto same = today.find(id);
      if (same == today.end()) {
        everGone[id] = pole;
        ++gone;
        continue;
      }
      EXPECT_EQ(same->second.x, pole.x) << id;
      EXPECT_EQ(same->second.y, pole.y) << id;
      EXPECT_EQ(same->second.radius, pole.radius) << id;
    }
    for (const auto& [id, pole] : today) {
      EXPECT_EQ(everGone.count(id), 0u) << id << " is back on day " << day;
      come += day > 0 && before.count(id) == 0;
    }
    before = today;
  }
  EXPECT_GT(gone, 30u);
  EXPECT_GT(come, 30u);
}

TEST(WorldYear, TheGivenShareIsReplacedInAYear) {
  constexpr double kShare = 0.4;
  double all = 0, gone = 0, come = 0, beside = 0;
  for (std::uint64_t seed = 41; seed <= 44; ++seed) {
    WorldOptions options = street(seed, 0, 600);
    options.replacedPerYear = kShare;
    const auto first = tests::polesById(makeWorld(options));
    options.day = 365;
    const auto last = tests::polesById(makeWorld(options));
    all += static_cast<double>(first.size());
    for (const auto& [id, pole] : first) gone += last.count(id) == 0;
    for (const auto& [id, pole] : last) {
      if (first.count(id) > 0) continue;
      ++come;
      for (const auto& [other, old] : first)
        if (last.count(other) == 0 && std::hypot(old.x - pole.x, old.y - pole.y) < 5.2) {
          ++beside;
          break;
        }
    }
  }
  ASSERT_GT(all, 700);
  const double sigma = std::sqrt(all * kShare * (1 - kShare));
  EXPECT_NEAR(gone, kShare * all, 4 * sigma);
  EXPECT_NEAR(come, kShare * all, 4 * sigma);
  EXPECT_GT(beside, 0.3 * come);
  EXPECT_LT(beside, 0.8 * come);
}

TEST(WorldYear, OnTheDayOfTheMapNothingHasChangedYet) {
  const World plain = makeWorld(street(51, 0));
  WorldOptions options = street(51, 0);
  options.replacedPerYear = 0.5;
  options.dayOfYear = 196;  // full leaf, no snow
  const World year = makeWorld(options);
  ASSERT_EQ(year.objects().size(), plain.objects().size());
  for (std::size_t i = 0; i < plain.objects().size(); ++i) {
    EXPECT_EQ(year.objects()[i].id, plain.objects()[i].id);
    EXPECT_EQ(year.objects()[i].centre, plain.objects()[i].centre);
    ASSERT_EQ(year.objects()[i].solids.size(), plain.objects()[i].solids.size());
    for (std::size_t k = 0; k < plain.objects()[i].solids.size(); ++k)
      EXPECT_EQ(year.objects()[i].solids[k].density, plain.objects()[i].solids[k].density);
  }
}

TEST(WorldYear, TreesAreBareInJanuary) {
  WorldOptions options = street(52, 200);
  options.dayOfYear = 180;  // day 200 is 15 January
  const World world = makeWorld(options);
  for (const WorldObject& object : world.objects()) {
    if (object.kind != Kind::tree) continue;
    for (const Solid& solid : object.solids) EXPECT_EQ(solid.density, 0);
  }
}

TEST(WorldYear, SnowBanksHideWhatStandsAlongTheKerb) {
  for (const double height : {0.5, 0.8}) {
    WorldOptions options = street(53, 0);
    options.dayOfYear = 15;
    options.snowBank = height;
    const World winter = makeWorld(options);
    int along = 0, hidden = 0;
    for (const TruePole& pole : winter.poles()) {
      const double kerb = winter.terrain().edge(pole.x, pole.y);
      const double snow = winter.snowAt(pole.x, pole.y);
      EXPECT_LT(snow, 1.45 * height);
      if (kerb > 2.5) {
        EXPECT_EQ(snow, 0) << kerb;
      }
      if (kerb < 0.45 || kerb > 1.05) continue;
      ++along;
      if (snow == 0) continue;  // a gap
      ++hidden;
      EXPECT_GT(snow, height - 0.08) << kerb;
    }
    EXPECT_GT(along, 40);
    EXPECT_GT(hidden, 0.7 * along);
    const auto banks = [](const World& world) {
      return std::count_if(world.objects().begin(), world.objects().end(),
                           [](const WorldObject& object) { return object.kind == Kind::snowBank; });
    };
    EXPECT_GT(banks(winter), 0.5 * 2 * options.length / 4.5);  // of 4.5 m, on both sides
    options.dayOfYear = 196;
    const World summer = makeWorld(options);
    EXPECT_EQ(banks(summer), 0);
    for (const TruePole& pole : summer.poles()) EXPECT_EQ(summer.snowAt(pole.x, pole.y), 0);
  }
}

TEST(WorldYear, BuildingSitesStandForTheirTimeAndNoLonger) {
  std::map<std::uint64_t, BuildingSite> seen;
  std::map<std::uint64_t, std::set<int>> days;
  double standing = 0;
  constexpr int kStep = 10, kLast = 700;
  for (int day = 0; day <= kLast; day += kStep) {
    WorldOptions options = street(54, day);
    options.buildingSites = 4;
    options.clutter = options.parkedShare = 0;
    const World world = makeWorld(options);
    standing += static_cast<double>(world.buildingSites().size()) / (0.4 * (kLast / kStep + 1));
    for (const BuildingSite& site : world.buildingSites()) {
      const auto [known, isNew] = seen.emplace(site.seed, site);
      EXPECT_EQ(known->second.from, site.from);
      EXPECT_EQ(known->second.kerb, site.kerb);
      EXPECT_GE(site.endDay - site.firstDay, 30);
      EXPECT_LE(site.endDay - site.firstDay, 90);
      days[site.seed].insert(day);
    }
  }
  EXPECT_GT(seen.size(), 8u);
  EXPECT_NEAR(standing, 4, 1.6) << "per km";
  for (const auto& [seed, site] : seen)
    for (int day = 0; day <= kLast; day += kStep)
      EXPECT_EQ(days[seed].count(day) > 0, day >= site.firstDay && day < site.endDay) << day;
}

TEST(WorldYear, PolesComeBackWhenTheWorkIsDone) {
  WorldOptions options = street(55, 100);
  const auto usual = tests::polesById(makeWorld(options));
  options.buildingSites = 6;
  std::size_t missing = 0, extra = 0;
  for (const int day : {100, 200, 300}) {
    options.day = day;
    const World world = makeWorld(options);
    const auto today = tests::polesById(world);
    const auto& sites = world.buildingSites();
    const auto atSite = [&](const TruePole& pole, double reach) {
      return std::any_of(sites.begin(), sites.end(), [&](const BuildingSite& site) {
        return distance(site, pole.x, pole.y) < reach;
      });
    };
    for (const auto& [id, pole] : usual)
      if (today.count(id) == 0) {
        EXPECT_TRUE(atSite(pole, 4.6)) << "only from building sites";
        ++missing;
      }
    for (const auto& [id, pole] : today)
      if (usual.count(id) == 0) {
        EXPECT_TRUE(atSite(pole, 5)) << "signs before and behind them";
        ++extra;
      }
    for (const WorldObject& object : world.objects()) {
      if (object.kind != Kind::car) continue;
      for (const BuildingSite& site : sites)
        EXPECT_GT(distance(site, object.centre.x(), object.centre.y()), 1.0);
    }
  }
  EXPECT_GT(missing, 5u);
  EXPECT_GT(extra, 2u);
}

}  // namespace
}  // namespace polemcl::test_world_year
