#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>

#include <polemcl/mrpt/common/RegisterClasses.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>

namespace polemcl {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(CObservationPoles));
  mrpt::rtti::registerClass(CLASS_ID(CPoleMap));
}

}  // namespace polemcl

// For loading the library as a plugin.
MRPT_INITIALIZER(registerPolemclClasses) {
  polemcl::registerClasses();
}
