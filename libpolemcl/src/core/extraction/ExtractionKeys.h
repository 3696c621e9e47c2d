#pragma once
/// \file ExtractionKeys.h
/// \brief The keys of `[range_image]` and `[scan_line]` in sections of other names.

#include <polemcl/core/extraction/ExtractionOptions.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief As bind(), in the open section.
void bindKeys(Binder& binder, RangeImageOptions& options);
void bindKeys(Binder& binder, ScanLineOptions& options);

}  // namespace polemcl
