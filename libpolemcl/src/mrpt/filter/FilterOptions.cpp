#include "mrpt/filter/FilterOptions.h"

#include <cmath>
#include <vector>

namespace polemcl {

namespace {

void require(bool condition, const char* what) {
  if (!condition) throw Error(what);
}

struct Position {
  std::size_t numbers;
  void validate() const {
    require(numbers == 0 || numbers == 2, "position_m must be two numbers, x y, or none");
  }
};

}  // namespace

void FilterOptions::validate() const {
  require(particles >= 1 && particles <= 1000000, "particles must be 1 to 1000000");
  require(resampleBelow >= 0 && resampleBelow <= 1, "resample_below must be 0 to 1");
  require(bestShare > 0 && bestShare <= 1, "best_share must be above 0 and at most 1");
  require(regularization >= 0 && regularization <= 1, "regularization must be 0 to 1");
  require(tempering >= 0 && tempering <= resampleBelow,
          "tempering must be 0 to resample_below: it resamples too");
  require(tempering == 0 || regularization > 0,
          "tempering needs a regularization above 0: copies that stay where they are gain nothing");
  require(extraSigma >= 0 && extraSigma <= 10, "extra_sigma_m must be 0 to 10 m");
  kld.validate();
  require(!adaptive || resampleBelow > 0,
          "adaptive needs a resample_below above 0: the number changes when resampling");
  require(extraSigmaYaw >= 0 && extraSigmaYaw <= 1, "extra_sigma_deg must be 0 to 57 degrees");
}

void StartOptions::validate() const {
  require(!pose || (std::isfinite(pose->x) && std::isfinite(pose->y) && std::isfinite(pose->yaw)),
          "the start pose must be finite");
  require(radius >= 0 && radius <= maxRadius, "radius_m must be 0 to 10000 m");
  require(heading >= 0 && heading <= M_PI, "heading_deg must be 0 to 180 degrees");
  require(particles >= 1 && particles <= 1000000, "particles must be 1 to 1000000");
}

void RunOptions::validate() const {
  require(runs >= 1 && runs <= 10000, "runs must be 1 to 10000");
  // Seeds that overflow would repeat the runs of a neighbouring seed.
  require(seed <= UINT32_MAX - static_cast<std::uint32_t>(runs),
          "seed plus runs must stay below 4294967296");
}

void bind(Binder& binder, FilterOptions& options) {
  binder.section("filter", "The particle filter that localizes");
  binder.integer("particles", options.particles, Range::between(1, 1000000), "", "Particles");
  binder.flag("adaptive", options.adaptive,
              "Keep as many particles as the posterior needs (KLD sampling), not always as many");
  binder.number("kld_epsilon", options.kld.epsilon, {0, 1, true, false}, "nat",
                "Adaptive: greatest distance to the posterior in bins (Kullback, Leibler)");
  binder.number("kld_delta", options.kld.delta, {0, 0.5, true, false}, "probability",
                "Adaptive: of exceeding it");
  binder.number("kld_bin_m", options.kld.bin, Range::between(0.001, 100), "m",
                "Adaptive: size of a bin in x and y");
  binder.angleDeg("kld_bin_deg", options.kld.binYaw, Range::between(0.001, 180),
                  "Adaptive: size of a bin in heading");
  binder.integer("min_particles", options.kld.minParticles, Range::between(1, 1000000), "",
                 "Adaptive: never fewer");
  binder.integer("max_particles", options.kld.maxParticles, Range::between(1, 1000000), "",
                 "Adaptive: never more");
  binder.number("resample_below", options.resampleBelow, Range::between(0, 1), "share",
                "Resample when the effective share of the particles falls below; 0: never");
  binder.choice("resampling", options.resampling,
                {{Resampling::systematic, "systematic"},
                 {Resampling::stratified, "stratified"},
                 {Resampling::multinomial, "multinomial"}},
                "How particles are drawn");
  binder.choice("estimate", options.estimate,
                {{PoseEstimator::mean, "mean"}, {PoseEstimator::bestShare, "best_share"}},
                "Weighted mean of all particles, or of the best by weight (paper)");
  binder.number("best_share", options.bestShare, {0, 1, true, false}, "share",
                "The best by weight, for estimate = best_share (paper: 0.1)");
  binder.choice("estimate_time", options.estimateTime,
                {{EstimateTime::beforeResampling, "before_resampling"},
                 {EstimateTime::afterResampling, "after_resampling"}},
                "By the weights of the scan, or of equal copies where it led to resampling (first "
                "implementation)");
  binder.flag("heaviest_place", options.heaviestPlace,
              "true: of particles spread wide, the mean of the heaviest place; false: always as "
              "estimate says (paper)");
  binder.number("regularization", options.regularization, Range::between(0, 1), "share",
                "Resampled particles are moved by this share of the spread of all; 0: not at all "
                "(paper)");
  binder.number("tempering", options.tempering, Range::between(0, 1), "share",
                "A scan that leaves a lower effective share is used in steps; 0: at once (paper)");
  binder.number("extra_sigma_m", options.extraSigma, Range::between(0, 10), "m",
                "Noise added to each motion in x and y, standard deviation");
  binder.angleDeg("extra_sigma_deg", options.extraSigmaYaw, Range::between(0, 57),
                  "Noise added to each motion in heading, standard deviation");
  binder.check(options);
}

void bind(Binder& binder, StartOptions& options) {
  binder.section("start", "Where the filter starts");
  binder.flag("anywhere", options.anywhere,
              "true: nowhere in particular, the whole map is searched on the way");
  std::vector<double> position;
  if (options.pose) position = {options.pose->x, options.pose->y};
  double yaw = options.pose ? options.pose->yaw : 0;
  binder.numbers("position_m", position, Range::any(), "m",
                 "x y in the map frame; empty: the start is the first pose of the truth");
  binder.angleDeg("yaw_deg", yaw, Range::between(-360, 360), "Heading at that position");
  binder.check(Position{position.size()});
  options.pose.reset();
  if (!position.empty()) options.pose = Pose2D{position[0], position[1], wrapAngle(yaw)};
  binder.number("radius_m", options.radius, {0, StartOptions::maxRadius}, "m",
                "Radius of the disc of positions (paper: 2.5)");
  binder.choice("positions", options.positions,
                {{StartPositions::area, "area"}, {StartPositions::radius, "radius"}},
                "Uniform in the area of the disc, or in the distance from its centre (first "
                "implementation)");
  binder.angleDeg("heading_deg", options.heading, Range::between(0, 180),
                  "Headings are uniform in plus or minus this (paper: 5)");
  binder.integer("particles", options.particles, Range::between(1, 1000000), "",
                 "Drawn at the start; the first resampling keeps as many as [filter] says");
  binder.check(options);
}

void bind(Binder& binder, RunOptions& options) {
  binder.section("runs", "Repeated localizations of the same drive");
  binder.integer("runs", options.runs, Range::between(1, 10000), "", "How many (paper: 10)");
  binder.integer("seed", options.seed, Range::between(0, 4294967294.0), "",
                 "Seed of the first run; run i uses seed + i");
  binder.check(options);
}

}  // namespace polemcl
