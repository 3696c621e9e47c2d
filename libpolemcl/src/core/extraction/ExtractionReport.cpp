#include <iterator>

#include <polemcl/core/extraction/ExtractionReport.h>

namespace polemcl {

const char* name(RejectionReason reason) {
  static constexpr const char* names[] = {"too_few_points",
                                          "too_wide",
                                          "not_foreground",
                                          "too_low",
                                          "starts_too_high",
                                          "too_short",
                                          "bad_fit",
                                          "not_free",
                                          "tilted",
                                          "not_straight",
                                          "low_confidence",
                                          "duplicate",
                                          "none"};
  static_assert(std::size(names) == static_cast<int>(RejectionReason::count_) + 1);
  return names[static_cast<int>(reason)];
}

ExtractionReport& ExtractionReport::operator+=(const ExtractionReport& other) {
  points += other.points;
  invalid += other.invalid;
  outOfView += other.outOfView;
  outOfRange += other.outOfRange;
  candidates += other.candidates;
  for (std::size_t i = 0; i < std::size(refused); ++i) refused[i] += other.refused[i];
  if (ground == 0) ground = other.ground;
  return *this;
}

}  // namespace polemcl
