#include "mrpt/common/AllocationLimit.h"

namespace polemcl {

AllocationLimit::AllocationLimit(std::size_t most) {
  if (polemclAllocationLimit) *polemclAllocationLimit() = {most};
}

AllocationLimit::~AllocationLimit() {
  if (polemclAllocationLimit) *polemclAllocationLimit() = {};
}

bool AllocationLimit::reached() const {
  return polemclAllocationLimit && polemclAllocationLimit()->reached;
}

}  // namespace polemcl
