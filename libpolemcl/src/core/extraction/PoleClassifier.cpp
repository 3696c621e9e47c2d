#include "core/extraction/PoleClassifier.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

using Term = ClassifierTerm;

/// A row of a table of trees. Where a term is at most `value`, the next row follows; elsewhere that
/// `step` rows farther on. A leaf has a negative step: `value` counts, and the next tree begins
/// -`step` rows farther on. The first tree is a leaf alone.
struct TreeRow {
  Term term;
  double value;
  int step;
};
// The tables are rough_trees.csv and trees.csv, which share/experiments/fit_classifier.py wrote.
#define TERM(term, value, step) {Term::term, value, step},
constexpr TreeRow kRoughRows[] = {
#include "core/extraction/rough_trees.inc"
};
constexpr TreeRow kRows[] = {
#include "core/extraction/trees.inc"
};
#undef TERM

constexpr bool roughIsKnownBeforeFit() {
  for (const TreeRow& row : kRoughRows)
    for (const Term term : {Term::clutter, Term::excess, Term::radius, Term::density})
      if (row.term == term) return false;
  return true;
}
static_assert(roughIsKnownBeforeFit(), "rough_trees.csv asks for a term before it is known");

constexpr int kDepth = 4;
constexpr int kSplits = (1 << kDepth) - 1;

/// A tree with all splits down to kDepth, so that no branch depends on the terms: those that the
/// table lacks always go to the first of two equal leaves. The children of i are 2 i + 1, 2 i + 2.
struct Tree {
  std::array<Term, kSplits> term{};
  std::array<float, kSplits> limit{};
  std::array<float, kSplits + 1> leaf{};
};

/// Fills the part of `tree` below `node` from rows[i] on; returns the row of its last leaf.
/// Deeper trees than kDepth do not compile.
template <std::size_t n>
constexpr std::size_t unpack(const TreeRow (&rows)[n], std::size_t i, int node, Tree& tree) {
  const TreeRow& row = rows[i];
  if (node >= kSplits) {
    if (row.step > 0) throw "deeper than kDepth";
    tree.leaf[node - kSplits] = static_cast<float>(row.value);
    return i;
  }
  const bool leaf = row.step < 0;
  tree.term[node] = leaf ? Term::one : row.term;
  tree.limit[node] = leaf ? std::numeric_limits<float>::infinity() : static_cast<float>(row.value);
  unpack(rows, leaf ? i : i + 1, 2 * node + 1, tree);
  return unpack(rows, leaf ? i : i + row.step, 2 * node + 2, tree);
}

/// How many leaves end a tree: those whose step leads just behind them.
template <std::size_t n>
constexpr int countTrees(const TreeRow (&rows)[n]) {
  int trees = 0;
  for (const TreeRow& row : rows) trees += row.step == -1;
  return trees;
}

template <int trees, std::size_t n>
constexpr std::array<Tree, trees> unpackAll(const TreeRow (&rows)[n]) {
  std::array<Tree, trees> all{};
  std::size_t i = 0;
  for (Tree& tree : all) i = unpack(rows, i, 0, tree) + 1;
  if (i != n) throw "rows behind the last tree";
  return all;
}
constexpr auto kRoughTrees = unpackAll<countTrees(kRoughRows)>(kRoughRows);
constexpr auto kTrees = unpackAll<countTrees(kRows)>(kRows);

template <std::size_t n>
double sum(const std::array<Tree, n>& trees, const ClassifierTerms& terms) {
  std::array<float, kClassifierTerms> t;
  std::copy(terms.begin(), terms.end(), t.begin());
  double odds = 0;
  for (const Tree& tree : trees) {
    int node = 0;
    for (int level = 0; level < kDepth; ++level)
      node = 2 * node + 2 - (t[static_cast<int>(tree.term[node])] <= tree.limit[node]);
    odds += tree.leaf[node - kSplits];
  }
  return odds;
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
  return sum(kRoughTrees, classifierTerms(features));
}

double poleOdds(const PoleFeatures& features) {
  return sum(kTrees, classifierTerms(features));
}

}  // namespace polemcl
