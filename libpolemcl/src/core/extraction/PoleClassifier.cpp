#include "core/extraction/PoleClassifier.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace polemcl {
namespace {

enum Term {
  one,
  logSegments,
  logPoints,
  extent,
  passed,
  wide,
  notWhole,
  scatter,
  widthSpread,
  lowTop,
  roughRadius,
  top,
  bottom,
  clutter,
  excess,
  highBottom,
  tilt,
  range,
  radius,
  density,
  terms
};
using Terms = std::array<double, terms>;

/// One term: how it is brought to mean 0 and variance 1, and its weights.
struct Weight {
  double mean, scale, full, rough;
};

// Penalized logistic regression on simulated streets, worlds 101 to 106 with eight scans of each of
// HDL-64E, HDL-32E, OS1-64 and VLP-16, the sensors weighing alike; products were added greedily by
// the gradient of the likelihood, as many as repeatability on a real drive bore.
constexpr std::array<Weight, terms> kWeights = {{
    {0, 1, -2.6032, -3.27265},                    // one
    {2.09088, 1.35838, -0.173793, -0.749212},     // logSegments
    {2.8676, 1.03279, 0.332273, 1.01863},         // logPoints
    {1.98989, 1.14071, 0.361639, 1.91677},        // extent
    {0.0289928, 11.604, -0.1904, -0.484396},      // passed
    {0.101788, 5.81971, -0.33188, -1.2533},       // wide
    {0.665324, 2.39347, -0.869093, -2.06051},     // notWhole
    {0.0590787, 31.0089, -0.233269, -0.733914},   // scatter
    {0.0504465, 15.9584, 0.36143, 0.672896},      // widthSpread
    {0.0627808, 5.51228, -0.105291, -0.0411834},  // lowTop
    {0.0900149, 11.8469, -0.16728, -0.835357},    // roughRadius
    {3.47533, 0.655779, -0.431751, -1.45154},     // top
    {0.686734, 1.85941, -0.0258637, 0.00448834},  // bottom
    {0.733018, 2.66295, -0.864781, 0},            // clutter
    {0.03435, 24.8417, -0.633032, 0},             // excess
    {0.117511, 3.91434, 0.0452978, 0.236516},     // highBottom
    {0.0906435, 10.3028, -0.111173, -0.63414},    // tilt
    {0.552457, 4.56444, -0.233833, 0.114812},     // range
    {0.154815, 6.47803, -0.17186, 0},             // radius
    {-0.235503, 1.12927, 0.0937023, 0},           // density
}};

struct Product {
  Term a, b;
  double weight;
};
constexpr Product kProducts[] = {
    {extent, notWhole, -0.535285},     {clutter, excess, 0.538301},
    {wide, widthSpread, -0.261537},    {notWhole, clutter, 0.284359},
    {extent, clutter, -0.285748},      {logSegments, range, -0.272408},
    {roughRadius, density, -0.325533}, {widthSpread, tilt, -0.252595},
};

Terms standardized(const PoleFeatures& f) {
  Terms t{};
  t[one] = 1;
  t[logSegments] = std::log(f.segments);
  t[logPoints] = std::log(f.points);
  t[extent] = std::min(3.0, f.extent);
  t[passed] = f.passed;
  t[wide] = f.wide;
  t[notWhole] = f.notWhole;
  t[scatter] = f.scatter;
  t[widthSpread] = f.widthSpread;
  t[lowTop] = f.missingTop;
  t[roughRadius] = f.roughRadius;
  t[top] = std::min(6.0, f.top);
  t[bottom] = f.bottom;
  t[clutter] = f.clutter;
  t[excess] = std::max(0.0, f.residual - 0.02);
  t[highBottom] = std::max(0.0, f.bottom - 1);
  t[tilt] = f.tilt;
  t[range] = f.range / 40;
  t[radius] = f.radius;
  t[density] = std::log(f.points / f.segments / std::max(1.0, 2 * f.radius / f.columnWidth));
  for (int i = one + 1; i < terms; ++i)
    t[i] = std::clamp((t[i] - kWeights[i].mean) * kWeights[i].scale, -3.0, 3.0);
  return t;
}

}  // namespace

double roughOdds(const PoleFeatures& features) {
  const Terms t = standardized(features);
  double odds = 0;
  for (int i = 0; i < terms; ++i) odds += kWeights[i].rough * t[i];
  return odds;
}

double poleOdds(const PoleFeatures& features) {
  const Terms t = standardized(features);
  double odds = 0;
  for (int i = 0; i < terms; ++i) odds += kWeights[i].full * t[i];
  for (const Product& p : kProducts) odds += p.weight * t[p.a] * t[p.b];
  return odds;
}

}  // namespace polemcl
