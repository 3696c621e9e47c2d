#include "mrpt/filter/FilterOptions.h"

#include <vector>

#include "core/common/Binder.h"

namespace polemcl {
namespace {

const Range kShareOfFilter = Range::between(0, 1), kParticleNumber = Range::between(1, 1000000);

void bindEstimate(Binder& b, FilterOptions& o) {
  b.choice<Resampling>("resampling", o.resampling,
                       {{Resampling::systematic, "systematic"},
                        {Resampling::stratified, "stratified"},
                        {Resampling::multinomial, "multinomial"}},
                       "how particles are drawn");
  b.choice<PoseEstimator>("estimate", o.estimate,
                          {{PoseEstimator::mean, "mean"}, {PoseEstimator::bestShare, "best_share"}},
                          "weighted mean of all particles, or of the best by weight (paper)");
  b.number("best_share", o.bestShare, Range::aboveUpTo(0, 1), "share",
           "estimate = best_share: share of the particles that are averaged (paper: 0.1)");
  b.choice<EstimateTime>("estimate_time", o.estimateTime,
                         {{EstimateTime::beforeResampling, "before_resampling"},
                          {EstimateTime::afterResampling, "after_resampling"}},
                         "estimate by the weights of the scan, or by the equal copies after "
                         "resampling (authors' program)");
  b.flag("heaviest_place", o.heaviestPlace,
         "true: particles in several places give the mean of the heaviest place; false: always "
         "as estimate says (paper)");
}

}  // namespace

void bind(Binder& b, FilterOptions& o) {
  b.section("filter", "The particle filter that localizes", Tier::sensor);
  b.number("extra_sigma_m", o.extraSigma, Range::between(0, 10), "m",
           "standard deviation of the noise added to each motion in x and y");
  b.angleDeg("extra_sigma_deg", o.extraSigmaYaw, Range::between(0, 57),
             "standard deviation of the noise added to each motion in heading");
  b.tier(Tier::tuning);
  b.integer("particles", o.particles, kParticleNumber, "", "number of particles");
  b.number("resample_below", o.resampleBelow, kShareOfFilter, "share",
           "effective share of the particles below which they are resampled; 0: never");
  b.flag("adaptive", o.adaptive,
         "true: resampling keeps the number of particles that the posterior needs (KLD sampling)");
  bind(b, o.kld);
  b.tier(Tier::expert);
  bindEstimate(b, o);
  b.number(
      "regularization", o.regularization, kShareOfFilter, "share",
      "resampled particles are moved by this share of the spread of all; 0: they stay (paper)");
  b.number("tempering", o.tempering, kShareOfFilter, "share",
           "a scan that would leave a lower effective share is used in steps; 0: at once (paper)");

  b.require(o.tempering <= o.resampleBelow, "tempering", o.tempering,
            "resample_below or less: it resamples too");
  b.require(o.tempering == 0 || o.regularization > 0, "tempering", o.tempering,
            "0 where regularization = 0: copies that stay where they are gain nothing");
  b.require(!o.adaptive || o.resampleBelow > 0, "adaptive", "true",
            "false where resample_below = 0: the number changes when resampling");
}

void bind(Binder& b, StartOptions& o) {
  b.section("start", "Where the filter starts");
  b.flag("anywhere", o.anywhere, "true: no start pose; the global search finds it on the way");
  std::vector<double> position;
  if (o.pose) position = {o.pose->x, o.pose->y};
  double yaw = o.pose ? wrapAngle(o.pose->yaw) : 0;
  b.numbers("position_m", position, Range::any(), "m",
            "start x y in the map frame; empty: the first pose of the truth");
  b.angleDeg("yaw_deg", yaw, Range::between(-360, 360), "heading at position_m");
  b.require(position.empty() || position.size() == 2, "position_m",
            static_cast<double>(position.size()),
            "two numbers, x y, or an empty list (the value is their number)");
  o.pose.reset();
  if (!position.empty()) o.pose = Pose2D{position[0], position[1], wrapAngle(yaw)};
  b.number("radius_m", o.radius, Range::between(0, StartOptions::maxRadius), "m",
           "radius of the disc of positions (paper: 2.5)");
  b.angleDeg("heading_deg", o.heading, Range::between(0, 180),
             "headings are uniform in plus or minus this (paper: 5)");
  b.integer("particles", o.particles, kParticleNumber, "",
            "number of particles until the first resampling");
  b.tier(Tier::expert);
  b.choice<StartPositions>(
      "positions", o.positions,
      {{StartPositions::area, "area"}, {StartPositions::radius, "radius"}},
      "uniform in the area of the disc, or in the distance from its centre (authors' "
      "program)");
}

void bind(Binder& b, RunOptions& o) {
  b.section("runs", "Repeated localizations of the same drive");
  b.integer("runs", o.runs, Range::between(1, 10000), "", "number of runs (paper: 10)");
  b.integer("seed", o.seed, Range::between(0, 4294967294.0), "",
            "seed of the first run; run i uses seed + i");
  // Seeds that wrap round would repeat runs of a neighbouring seed.
  b.require(o.seed <= UINT32_MAX - static_cast<std::uint32_t>(o.runs), "seed", o.seed,
            "a number with seed + runs below 4294967296");
}

}  // namespace polemcl
