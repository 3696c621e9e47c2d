#pragma once
/// \file Maps.h
/// \brief The map that the classes of the Python module share.

#include "core/common/PoleIndex.h"
#include "map/MapFiles.h"

namespace polemcl::apps::python {

/// \brief A map with all that its file holds. Never changed, so threads and objects may share it.
struct PoleMap {
  /// \throws Error on a pole whose place or covariance is not finite.
  explicit PoleMap(MapContent mapContent);
  MapContent content;
  PoleIndex index;
};

}  // namespace polemcl::apps::python
