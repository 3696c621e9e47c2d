#include "core/extraction/ExtractionReport.h"

namespace polemcl {

const char* name(Refusal reason) {
  switch (reason) {
    case Refusal::tooFewPoints:
      return "too_few_points";
    case Refusal::tooWide:
      return "too_wide";
    case Refusal::notForeground:
      return "not_foreground";
    case Refusal::tooLow:
      return "too_low";
    case Refusal::startsTooHigh:
      return "starts_too_high";
    case Refusal::tooShort:
      return "too_short";
    case Refusal::badFit:
      return "bad_fit";
    case Refusal::notFree:
      return "not_free";
    case Refusal::tilted:
      return "tilted";
    case Refusal::notStraight:
      return "not_straight";
    case Refusal::lowConfidence:
      return "low_confidence";
    case Refusal::duplicate:
      return "duplicate";
    case Refusal::count_:
      break;
  }
  return "none";
}

}  // namespace polemcl
