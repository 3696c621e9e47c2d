#pragma once
/// \file PathSections.h
/// \brief A path split into sections of equal length along the distance travelled.

#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Middles and ends of sections, as a vehicle passes them one scan after the other.
///
/// This is the rule of the authors' program. The middle of section n is the first scan at or
/// past n + 1/2 sections of the path. The end of section n is the first scan past n + 1. A scan is
/// the middle of at most one section. Scans may be farther apart than a section is long: then each
/// scan is a middle, and the count of sections falls behind. Later scans catch up, one section
/// each, also while the vehicle stands.
class POLEMCL_EXPORT SectionMarks {
 public:
  /// \param length Length of a section, > 0, m.
  explicit SectionMarks(double length) : m_length(length) {}
  /// \brief The next scan. \param travelled Distance up to it, m.
  void pass(double travelled);
  bool middle() const { return m_middle; }  ///< this scan is the middle of section middles() - 1
  bool end() const { return m_end; }        ///< section ends() - 1 ends at this scan
  std::size_t middles() const { return m_middles; }  ///< so far
  std::size_t ends() const { return m_ends; }        ///< so far, at most middles()

 private:
  double m_length;
  std::size_t m_middles = 0, m_ends = 0;
  bool m_middle = false, m_end = false;
};

/// \brief A section with at least one scan.
struct PathSection {
  std::uint32_t path = 0;  ///< 0 for the first drive, 1 for the second, …
  std::size_t index = 0;   ///< number of the section on its path: [index, index + 1) · length
  std::vector<std::size_t> scans;  ///< by ascending index
  std::size_t middle =
      0;  ///< the scan nearest to the middle of the section; the first one wins ties
};

struct PathSections {
  std::vector<PathSection> occupied;  ///< in the order travelled
  std::size_t count =
      0;              ///< all sections, also those between scans; none that only unused scans pass
  double length = 0;  ///< of all paths, m
};

/// \brief Splits the distance travelled.
///
/// The length grows only by motion away from the place where the last part of a section ended.
/// The jitter of a standing vehicle adds nothing, so no place counts twice.
/// \param poses Finite, in the order travelled.
/// \param drives One per pose; where it changes, a new path begins with a new section.
/// \param sectionLength > 0, m.
/// \param used One a pose, or empty for all: the others are part of the path only, no scan.
POLEMCL_EXPORT PathSections splitPath(const std::vector<Pose2D>& poses,
                                      const std::vector<std::uint32_t>& drives,
                                      double sectionLength, const std::vector<bool>& used = {});

/// \brief Splits the distance travelled by the rule of SectionMarks. A section has one scan, its
/// middle. A section whose end was not reached is left out. All steps between poses add to the
/// distance, also the jitter of a standing vehicle.
POLEMCL_EXPORT PathSections passSections(const std::vector<Pose2D>& poses,
                                         const std::vector<std::uint32_t>& drives,
                                         double sectionLength, const std::vector<bool>& used = {});

}  // namespace polemcl
