#include "cli/Version.h"
#include "python/Arrays.h"
#include "python/Classes.h"

namespace py = pybind11;

namespace {

void requireNumpy() {
  try {
    py::module_::import("numpy");
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
    py::raise_from(error, PyExc_ImportError,
                   "polemcl needs NumPy, which this Python does not have; Debian: apt install "
                   "python3-numpy");
    throw py::error_already_set();
  }
}

}  // namespace

/// The module `polemcl`, see share/doc/python.md.
PYBIND11_MODULE(polemcl, module) {
  using namespace polemcl::apps;
  module.doc() =
      "Pole-based LiDAR localization. Metres, radians, seconds. See share/doc/python.md.";
  requireNumpy();
  module.attr("__version__") = version();
  module.attr("detection_type") = python::detectionType();
  module.attr("map_pole_type") = python::mapPoleType();
  py::register_exception<polemcl::Error>(module, "Error", PyExc_RuntimeError);
  python::addExtraction(module);
  python::addMaps(module);
  python::addLocalization(module);
}
