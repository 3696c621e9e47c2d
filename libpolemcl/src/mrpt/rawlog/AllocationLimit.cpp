#include "mrpt/rawlog/AllocationLimit.h"

namespace polemcl {

AllocationLimit::AllocationLimit(std::size_t bytes) {
  if (polemclAllocationLimit) *polemclAllocationLimit() = {bytes, false};
}

AllocationLimit::~AllocationLimit() {
  if (polemclAllocationLimit) polemclAllocationLimit()->left = -1;
}

bool AllocationLimit::reached() {
  return polemclAllocationLimit && polemclAllocationLimit()->reached;
}

}  // namespace polemcl
