#include <mrpt/rtti/CObject.h>

#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>

namespace polemcl {

/// While a program starts, a class may not have its name yet: Clang sets it later than GCC. It then
/// registers itself.
void registerClasses() {
  for (const auto* id : {CLASS_ID(CObservationPoles), CLASS_ID(CPoleMap)})
    if (id->className) mrpt::rtti::registerClass(id);
}

}  // namespace polemcl
