#include "sim/detections/NoiseFit.h"

#include <algorithm>
#include <cmath>

#include "sim/common/NormalDistribution.h"

namespace polemcl::sim {
namespace {
constexpr double kThresholdStep = 0.1;
constexpr std::size_t kParts = 2 * kNoiseReach.size();
}  // namespace

NoiseSpectrum fitSpectrum(const std::vector<LagCorrelation>& counted) {
  // Columns: parts that are permanent, then parts of the day.
  std::vector<std::array<double, kParts>> rows;
  for (const LagCorrelation& pair : counted) {
    std::array<double, kParts> row{};
    for (std::size_t k = 0; k < kNoiseReach.size(); ++k) {
      row[k] = noiseCorrelation(kNoiseReach[k], pair.distance);
      row[k + kNoiseReach.size()] = pair.sameDay ? row[k] : 0;
    }
    rows.push_back(row);
  }
  std::array<double, kParts> share{};
  constexpr int kSweeps = 5000;
  for (int sweep = 0; sweep < kSweeps; ++sweep)  // one share after the other, never below 0
    for (std::size_t k = 0; k < kParts; ++k) {
      double slope = 0, square = 1e-9;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        double rest = counted[i].correlation;
        for (std::size_t j = 0; j < kParts; ++j)
          if (j != k) rest -= rows[i][j] * share[j];
        slope += rows[i][k] * rest;
        square += rows[i][k] * rows[i][k];
      }
      share[k] = std::max(0.0, slope / square);
    }
  double sum = 0;
  for (const double part : share) sum += part;
  NoiseSpectrum spectrum;
  for (std::size_t k = 0; k < kNoiseReach.size(); ++k) {
    spectrum.always[k] = share[k] / std::max(1.0, sum);
    spectrum.today[k] = share[k + kNoiseReach.size()] / std::max(1.0, sum);
  }
  return spectrum;
}

void PairedNumbers::add(double a, double b) {
  ++m_count;
  m_ab += a * b;
  m_aa += a * a;
  m_bb += b * b;
}

double PairedNumbers::correlation() const {
  return m_aa > 0 && m_bb > 0 ? m_ab / std::sqrt(m_aa * m_bb) : 0;
}

void PairedHits::add(double h, double k, bool both) {
  const auto cell = [](double x) { return static_cast<int>(std::lround(x / kThresholdStep)); };
  ++m_cells[{cell(h), cell(k)}];
  ++m_count;
  m_both += both;
}

double PairedHits::correlation() const {
  double low = -0.9, high = 0.999;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    double expected = 0;
    for (const auto& [cell, pairs] : m_cells)
      expected +=
          static_cast<double>(pairs) *
          bivariateNormalCdf(cell.first * kThresholdStep, cell.second * kThresholdStep, middle);
    (expected < static_cast<double>(m_both) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace polemcl::sim
