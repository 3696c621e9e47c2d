#pragma once
/// \file PoleExistence.h
/// \brief Whether a mapped pole still stands: its probability, from scans that saw it and scans
/// that should have.
///
/// A binary Bayes filter in log-odds with a survival prior between sessions, as the persistence
/// filter has it for features of semi-static maps (Rosen, Mason and Leonard 2016, "Towards lifelong
/// feature-based mapping in semi-static environments": detections with a chance of a miss and of a
/// false alarm, a prior on how long a feature lasts). Unlike there, scans are not taken for
/// independent: one metre farther on, the same car stands before the same pole.

#include <cstdint>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// Probability that a scan finds a pole in view. The pole's own counts are used where they say
/// less.
constexpr double kDetection = 0.75;
/// Probability that a scan finds something where no pole is. With these two, a place found in more
/// than about 0.37 of the scans that could see it stays a pole.
constexpr double kFalseDetection = 0.08;
constexpr double kDecorrelation = 5;  ///< scans within this distance count as one, m
constexpr double kPrior = 0.2;        ///< probability that a newly observed object is a pole
constexpr double kCertain = 0.99;     ///< greatest probability of existence; the least is 1 - this

/// \brief What is known of a pole over the sessions.
struct PoleHistory {
  std::uint32_t seen = 0;    ///< scans within `range_m` that found it
  std::uint32_t missed = 0;  ///< scans within `range_m` that should have: in free view, not found
  double existence = 0.5;    ///< probability that it stands, in (0, 1)
  double firstSeen = 0;      ///< s since 1970; 0: not known
  double lastSeen = 0;       ///< s since 1970; 0: not known
};

/// \brief True for a time of the calendar. Earlier ones, of the first day of 1970, are those of a
/// drive that has a clock of its own; they do not tell when a pole was seen.
POLEMCL_EXPORT bool isDate(double seconds);
/// \brief Notes that the pole was seen, unless the time is no date.
POLEMCL_EXPORT void noteSeen(PoleHistory& history, double seconds);

/// \brief Chance that a pole is found in a scan that could see it: from its counts, with
/// kDetection counting as 20 scans; at most kDetection, and at least twice kFalseDetection, so
/// that misses always count against it.
POLEMCL_EXPORT double detectionChance(const PoleHistory& history);

/// \brief Probability after a time without news: it decays as exp(-days / lifetime).
/// \param seconds Since it was last updated; negative ones count as 0.
POLEMCL_EXPORT double survived(double existence, double seconds, double lifetimeDays);

/// \brief Collects what the scans of a session say of one pole, section by section.
class POLEMCL_EXPORT ExistenceLikelihood {
 public:
  /// \param along Way travelled to the scan, m; never less than before.
  /// \param hidden Something stands before the place. Such scans count with a small chance of
  /// detection. They count only if one of them found the pole; then all of them do, also those
  /// that did not find it. They never count as missed().
  void add(bool found, double along, double chance, bool hidden = false);
  std::uint32_t found() const { return m_found; }
  std::uint32_t missed() const { return m_missed; }
  /// \brief Log of the ratio of likelihoods, of a pole to none: the mean over the scans of a
  /// section, summed over the sections.
  double logRatio() const;

 private:
  /// Mean over the scans of a section, summed over the sections.
  struct SectionSum {
    double done = 0;              ///< of the sections before
    double sum = 0;               ///< of the section under way
    std::uint32_t inSection = 0;  ///< scans in it
    std::int64_t section = -1;    ///< its number
    void add(std::int64_t number, double value);
    double total() const;
  };
  std::uint32_t m_found = 0, m_missed = 0;
  bool m_foundHidden = false;
  SectionSum m_inView, m_all;
};

/// \brief Probability after a session, kept within kCertain.
POLEMCL_EXPORT double updated(double existence, double logRatio);

}  // namespace polemcl
