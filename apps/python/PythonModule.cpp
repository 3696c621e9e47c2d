#include "cli/Version.h"
#include "python/Arrays.h"
#include "python/Classes.h"

namespace py = pybind11;

/// The module `polemcl`, see share/doc/python.md.
PYBIND11_MODULE(polemcl, module) {
  using namespace polemcl::apps;
  module.doc() =
      "Pole-based LiDAR localization. Metres, radians, seconds. See share/doc/python.md.";
  module.attr("__version__") = version();
  module.attr("detection_type") = python::detectionType();
  module.attr("map_pole_type") = python::mapPoleType();
  py::register_exception<polemcl::Error>(module, "Error", PyExc_RuntimeError);
  python::addExtraction(module);
  python::addMaps(module);
  python::addLocalization(module);
}
