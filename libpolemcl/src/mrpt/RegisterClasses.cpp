#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <polemcl/mrpt/CObservationPoles.h>
#include <polemcl/mrpt/CPoleMap.h>
#include <polemcl/mrpt/RegisterClasses.h>

namespace polemcl {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(CObservationPoles));
  mrpt::rtti::registerClass(CLASS_ID(CPoleMap));
}

}  // namespace polemcl

// When the library is loaded as a plugin.
MRPT_INITIALIZER(registerPolemclClasses) {
  polemcl::registerClasses();
}
