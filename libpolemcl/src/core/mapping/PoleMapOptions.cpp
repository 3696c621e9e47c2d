#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/Binder.h"

namespace polemcl {

void bind(Binder& b, PoleMapOptions& o) {
  b.section("map", "How a map is built");
  b.tier(Tier::sensor);
  b.number("min_count", o.minCount, Range::above(0), "",
           "least count of a pole, see counting; less where scans are farther apart than sections");
  b.number("min_confidence", o.minConfidence, Range::between(0, 1), "",
           "detections with a lower confidence are not used; scans are searched down to it; "
           "0: to that of [scan_line]");
  b.tier(Tier::tuning);
  b.number("section_length_m", o.sectionLength, Range::atLeast(0.01), "m",
           "length of a section of the path");
  b.flag("every_scan", o.everyScan,
         "true: all scans are used; false: the middle one of each section (paper)");
  b.number("min_share", o.minShare, Range::between(0, 1), "",
           "least share of the sections within 15 m that saw the pole, see counting");
  b.number("pose_sigma_m", o.poseSigma, Range::between(0, 1000), "m",
           "standard deviation of the true positions");
  b.angleDeg("heading_sigma_deg", o.headingSigma, Range::between(0, 57),
             "standard deviation of the true headings; far detections count less");
  b.tier(Tier::expert);
  b.choice<SectionMiddle>(
      "middle", o.middle, {{SectionMiddle::nearest, "nearest"}, {SectionMiddle::passed, "passed"}},
      "middle scan of a section: the nearest to its middle, or the first past it (authors' "
      "program)");
  b.choice<MapMerging>(
      "merging", o.merging, {{MapMerging::gated, "gated"}, {MapMerging::boxes, "boxes"}},
      "detections are one pole by distance, or where their boxes overlap (authors' "
      "program)");
  b.choice<PoleCounting>("counting", o.counting,
                         {{PoleCounting::run, "run"},
                          {PoleCounting::confidences, "confidences"},
                          {PoleCounting::members, "members"}},
                         "count of a pole: sections of one run (paper), the sum of their greatest "
                         "confidences, or detections (authors' program)");
  b.number("unvisited_m", o.unvisited, Range::atLeast(0), "m",
           "later sessions: least distance of a scan from all places visited before; 0: all");

  b.require(!o.everyScan || o.middle != SectionMiddle::passed, "middle", "passed",
            "nearest where every_scan = true");
}

}  // namespace polemcl
