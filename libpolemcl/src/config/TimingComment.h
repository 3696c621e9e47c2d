#pragma once
/// \file TimingComment.h
/// \brief Measuring times of scans, stated in the comment of a rawlog or in a file.

#include <string>

#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl {

/// \brief Text of a comment: a section `[scan_timing]` as in INI files, the text before it for
/// people.
std::string timingComment(const ScanTiming& timing);
/// \brief The timing in a comment; `auto` if it has no such section.
/// \param rawlog Name for messages. \throws Error when the section cannot be read.
ScanTiming timingIn(const std::string& comment, const std::string& rawlog);
/// \brief The timing in an INI file that has this section only.
/// \throws Error naming the file when it cannot be read, lacks the section, or has another one.
ScanTiming timingInFile(const std::string& file);

}  // namespace polemcl
