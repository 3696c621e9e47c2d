#pragma once
/// \file AlignmentOptions.h
/// \brief How a session is aligned to the map before it updates it, and what the alignment did.

#include <polemcl/core/common/Binder.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief The part of `[map_update]` in INI files that says how far the poses of a session may be
/// off, and how slowly these errors change along the path.
struct POLEMCL_EXPORT AlignmentOptions {
  /// Standard deviation of the errors of a session's positions along an axis, m (`align_sigma_m`);
  /// 0: sessions are taken as they are.
  double sigma = 0.2;
  double headingSigma = 0.007;  ///< of its headings, rad (`align_sigma_deg`)
  /// Distance over which these errors are correlated: their correlation falls by e, m
  /// (`align_length_m`).
  double length = 100;
  /// Least number of map poles seen within a piece of 50 m of path. Pieces with fewer follow the
  /// pieces beside them (`align_min_poles`).
  int minPoles = 5;
};

POLEMCL_EXPORT void bind(Binder& binder, AlignmentOptions& options);  ///< `[map_update]`

/// \brief What the alignment of one session did.
struct AlignmentSummary {
  std::size_t scans = 0;    ///< scans in pieces with enough poles of the map
  double meanShift = 0;     ///< mean length of the corrections of these scans, m
  double largestShift = 0;  ///< m
  double largestTurn = 0;   ///< rad
};

}  // namespace polemcl
