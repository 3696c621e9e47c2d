#include "core/extraction/PoleClassifier.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

using Term = ClassifierTerm;

/// One term of roughOdds(): how it is brought to mean 0 and variance 1, and its weight.
struct Weight {
  Term term;
  double mean, scale, rough;
};
// The table is classifier.csv, which share/experiments/fit_classifier.py wrote.
#define CLASSIFIER_TERM(term, mean, scale, rough) {Term::term, mean, scale, rough},
constexpr Weight kWeights[] = {
#include "core/extraction/classifier.inc"
};
#undef CLASSIFIER_TERM

/// Where a term is at most `value`, the next node follows; elsewhere that `step` nodes farther on.
/// A leaf has a negative step: `value` counts, and the next tree begins -`step` nodes farther on.
struct TreeNode {
  Term term;
  double value;
  int step;
};
// The table is trees.csv, by the same script. The first tree is a leaf alone.
#define TREES_TERM(term, value, step) {Term::term, value, step},
constexpr TreeNode kTrees[] = {
#include "core/extraction/trees.inc"
};
#undef TREES_TERM

constexpr bool inOrder() {
  int expected = 0;
  for (const Weight& weight : kWeights)
    if (static_cast<int>(weight.term) != expected++) return false;
  return expected == kClassifierTerms;
}
static_assert(inOrder(), "classifier.csv must list the terms in the order of ClassifierTerm");

constexpr bool noStepLeavesTheTable() {
  int rows = static_cast<int>(std::size(kTrees));
  for (const TreeNode& node : kTrees) {
    if (node.step < 0 ? -node.step > rows : node.step < 2 || node.step >= rows) return false;
    --rows;  // that are left, from the next node on
  }
  return true;
}
static_assert(noStepLeavesTheTable(), "trees.csv has a step that leads out of it");

/// What is measured by or after the fit of a cylinder is not known to roughOdds().
constexpr bool roughIsKnownBeforeFit() {
  for (const Term term : {Term::clutter, Term::excess, Term::radius, Term::density})
    if (kWeights[static_cast<int>(term)].rough != 0) return false;
  return true;
}
static_assert(roughIsKnownBeforeFit(), "classifier.csv weighs a term before it is known");

/// Greatest distance of a term from its mean, in standard deviations; more counts as this.
constexpr double kFarthestTerm = 3;

/// The terms brought to mean 0 and variance 1, cut off at kFarthestTerm; the first one is 1.
ClassifierTerms standardTerms(const PoleFeatures& features) {
  ClassifierTerms terms = classifierTerms(features);
  for (int i = 1; i < kClassifierTerms; ++i)
    terms[i] = std::clamp((terms[i] - kWeights[i].mean) * kWeights[i].scale, -kFarthestTerm,
                          kFarthestTerm);
  return terms;
}

double& at(ClassifierTerms& t, Term term) {
  return t[static_cast<int>(term)];
}

}  // namespace

const char* name(ClassifierTerm term) {
  static constexpr const char* names[] = {
      "one",     "logSegments", "logPoints", "extent",      "passed", "wide",   "notWhole",
      "scatter", "widthSpread", "lowTop",    "roughRadius", "top",    "bottom", "clutter",
      "excess",  "highBottom",  "tilt",      "range",       "radius", "density"};
  static_assert(std::size(names) == kClassifierTerms);
  return names[static_cast<int>(term)];
}

ClassifierTerms classifierTerms(const PoleFeatures& f) {
  ClassifierTerms t{};
  at(t, Term::one) = 1;
  at(t, Term::logSegments) = std::log(f.segments);
  at(t, Term::logPoints) = std::log(f.points);
  at(t, Term::extent) = std::min(3.0, f.extent);
  at(t, Term::passed) = f.passed;
  at(t, Term::wide) = f.wide;
  at(t, Term::notWhole) = f.notWhole;
  at(t, Term::scatter) = f.scatter;
  at(t, Term::widthSpread) = f.widthSpread;
  at(t, Term::lowTop) = f.missingTop;
  at(t, Term::roughRadius) = f.roughRadius;
  at(t, Term::top) = std::min(6.0, f.top);
  at(t, Term::bottom) = f.bottom;
  at(t, Term::clutter) = f.clutter;
  at(t, Term::excess) = std::max(0.0, f.residual - 0.02);
  at(t, Term::highBottom) = std::max(0.0, f.bottom - 1);
  at(t, Term::tilt) = f.tilt;
  at(t, Term::range) = f.range / 40;
  at(t, Term::radius) = f.radius;
  at(t, Term::density) =
      std::log(f.points / f.segments / std::max(1.0, 2 * f.radius / f.columnWidth));
  return t;
}

double roughOdds(const PoleFeatures& features) {
  const ClassifierTerms t = standardTerms(features);
  double odds = 0;
  for (int i = 0; i < kClassifierTerms; ++i) odds += kWeights[i].rough * t[i];
  return odds;
}

double poleOdds(const PoleFeatures& features) {
  ClassifierTerms t = classifierTerms(features);
  double odds = 0;
  for (const TreeNode* node = kTrees; node != std::end(kTrees);) {
    while (node->step > 0) node += at(t, node->term) <= node->value ? 1 : node->step;
    odds += node->value;
    node -= node->step;
  }
  return odds;
}

}  // namespace polemcl
