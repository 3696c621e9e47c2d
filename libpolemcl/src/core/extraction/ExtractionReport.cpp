#include <polemcl/core/extraction/ExtractionReport.h>

namespace polemcl {

const char* name(RejectionReason reason) {
  switch (reason) {
    case RejectionReason::tooFewPoints:
      return "too_few_points";
    case RejectionReason::tooWide:
      return "too_wide";
    case RejectionReason::notForeground:
      return "not_foreground";
    case RejectionReason::tooLow:
      return "too_low";
    case RejectionReason::startsTooHigh:
      return "starts_too_high";
    case RejectionReason::tooShort:
      return "too_short";
    case RejectionReason::badFit:
      return "bad_fit";
    case RejectionReason::notFree:
      return "not_free";
    case RejectionReason::tilted:
      return "tilted";
    case RejectionReason::notStraight:
      return "not_straight";
    case RejectionReason::lowConfidence:
      return "low_confidence";
    case RejectionReason::duplicate:
      return "duplicate";
    case RejectionReason::count_:
      break;
  }
  return "none";
}

}  // namespace polemcl
