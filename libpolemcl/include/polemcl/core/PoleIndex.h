#pragma once
/// \file PoleIndex.h
/// \brief Nearest pole within a radius, on nanoflann; built eagerly, safe to share between threads.

#include <polemcl/core/Types.h>

#include <memory>
#include <optional>
#include <vector>

namespace polemcl {

class PoleIndex {
 public:
  struct Neighbour {
    std::size_t index;  ///< into the poles given to the constructor
    double distance;    ///< m
  };
  explicit PoleIndex(const std::vector<MapPole>& poles);
  ~PoleIndex();
  PoleIndex(PoleIndex&&) noexcept;
  PoleIndex& operator=(PoleIndex&&) noexcept;

  std::size_t size() const;
  /// \brief The nearest pole with distance < radius, if any. Of equals, the lower index.
  std::optional<Neighbour> nearest(double x, double y, double radius) const;
  /// \brief All poles with distance < radius, sorted by distance then index.
  std::vector<Neighbour> within(double x, double y, double radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
