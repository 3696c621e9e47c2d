#include "core/global_localization/PreparedMap.h"

#include "core/common/Transform.h"

namespace polemcl {

PreparedMap::PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& globalOptions)
    : options((checkOptions(globalOptions), globalOptions)),
      index(map, options.maxTolerance),
      pairs(centresOf(map), options.minBaseline, options.maxBaseline) {
  for (std::size_t i = 0; i < map.size(); ++i)
    meanVariance += index.variance(i) / static_cast<double>(map.size());
}

}  // namespace polemcl
