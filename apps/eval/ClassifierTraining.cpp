#include "eval/ClassifierTraining.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/evaluation/LogisticRegression.h"
#include "core/extraction/CovarianceScale.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

struct Sample {
  ClassifierTerms terms;
  const LabelledCandidate* candidate;
  double weight;
};

/// Samples of all drives but one, with weights of mean 1, by which the sensors weigh alike.
std::vector<Sample> samplesOf(const std::vector<LabelledDrive>& drives, double realWeight,
                              std::optional<std::size_t> without = std::nullopt) {
  const auto weightOf = [&](const LabelledDrive& drive) { return drive.real ? realWeight : 1; };
  std::map<std::string, double> ofSensor;
  for (std::size_t d = 0; d < drives.size(); ++d)
    if (d != without)
      ofSensor[drives[d].sensor] +=
          weightOf(drives[d]) * static_cast<double>(drives[d].candidates.size());
  std::vector<Sample> samples;
  double all = 0;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (d == without) continue;
    const double weight = weightOf(drives[d]) / ofSensor[drives[d].sensor];
    for (const LabelledCandidate& candidate : drives[d].candidates) {
      samples.push_back({classifierTerms(candidate.features), &candidate, weight});
      all += weight;
    }
  }
  for (Sample& sample : samples) sample.weight *= static_cast<double>(samples.size()) / all;
  return samples;
}

/// The weights of both regressions, as in classifier.csv.
struct Weights {
  ClassifierTerms mean{}, scale{}, full{}, rough{};
  struct Product {
    int a, b;
    double weight;
  };
  std::vector<Product> products;

  ClassifierTerms standardized(const ClassifierTerms& terms) const {
    return polemcl::standardized(
        terms, [&](int i) { return mean[i]; }, [&](int i) { return scale[i]; });
  }
  double odds(const PoleFeatures& features) const {
    const ClassifierTerms t = standardized(classifierTerms(features));
    double sum = 0;
    for (int i = 0; i < kClassifierTerms; ++i) sum += full[i] * t[i];
    for (const Product& p : products) sum += p.weight * t[p.a] * t[p.b];
    return sum;
  }
};

void standardize(const std::vector<Sample>& samples, Weights& weights) {
  weights.scale[0] = 1;
  double total = 0;
  for (const Sample& sample : samples) total += sample.weight;
  for (int i = 1; i < kClassifierTerms; ++i) {
    double mean = 0, square = 0;
    for (const Sample& sample : samples) mean += sample.weight * sample.terms[i] / total;
    for (const Sample& sample : samples)
      square += sample.weight * std::pow(sample.terms[i] - mean, 2) / total;
    weights.mean[i] = mean;
    weights.scale[i] = square > 1e-12 ? 1 / std::sqrt(square) : 0;  // a constant says nothing
  }
}

struct Design {
  Eigen::MatrixXd terms;
  Eigen::VectorXd labels, weights;
};

Design designOf(const std::vector<Sample>& samples, const Weights& weights) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  Design design{Eigen::MatrixXd(n, kClassifierTerms), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const Sample& sample = samples[static_cast<std::size_t>(k)];
    const ClassifierTerms t = weights.standardized(sample.terms);
    for (int i = 0; i < kClassifierTerms; ++i) design.terms(k, i) = t[i];
    design.labels[k] = sample.candidate->pole;
    design.weights[k] = sample.weight;
  }
  return design;
}

/// The product that would raise the likelihood most: the greatest score statistic (gradient squared
/// by information) of those not taken. None if no product varies.
std::optional<Weights::Product> bestProduct(const Design& design, const Eigen::VectorXd& odds,
                                            const std::vector<Weights::Product>& taken) {
  const Eigen::ArrayXd p = probabilities(odds).array();
  const Eigen::ArrayXd residual = design.weights.array() * (design.labels.array() - p);
  const Eigen::ArrayXd information = design.weights.array() * p * (1 - p);
  std::optional<Weights::Product> best;
  double highest = -1;
  for (int a = 1; a < kClassifierTerms; ++a)
    for (int b = a + 1; b < kClassifierTerms; ++b) {
      if (std::any_of(taken.begin(), taken.end(),
                      [&](const Weights::Product& t) { return t.a == a && t.b == b; }))
        continue;
      const Eigen::ArrayXd product = design.terms.col(a).array() * design.terms.col(b).array();
      const double gradient = (residual * product).sum();
      const double squares = (information * product.square()).sum();
      if (!(squares > 0) || gradient * gradient / squares <= highest) continue;
      highest = gradient * gradient / squares;
      best = Weights::Product{a, b, 0};
    }
  return best;
}

Weights fit(const std::vector<Sample>& samples, const TrainOptions& options) {
  Weights weights;
  standardize(samples, weights);
  Design design = designOf(samples, weights);
  // Before the fit of a circle, less is known.
  Eigen::MatrixXd known = design.terms;
  for (int i = 0; i < kClassifierTerms; ++i)
    if (!knownBeforeFit(static_cast<ClassifierTerm>(i))) known.col(i).setZero();
  const Eigen::VectorXd rough = fitLogistic(known, design.labels, design.weights, options.ridge);
  Eigen::VectorXd full = fitLogistic(design.terms, design.labels, design.weights, options.ridge);
  for (int k = 0; k < options.products; ++k) {
    const auto best = bestProduct(design, design.terms * full, weights.products);
    if (!best) break;
    weights.products.push_back(*best);
    design.terms.conservativeResize(Eigen::NoChange, design.terms.cols() + 1);
    design.terms.rightCols<1>() = design.terms.col(best->a).cwiseProduct(design.terms.col(best->b));
    full = fitLogistic(design.terms, design.labels, design.weights, options.ridge);
  }
  for (int i = 0; i < kClassifierTerms; ++i) {
    weights.full[i] = full[i];
    weights.rough[i] = knownBeforeFit(static_cast<ClassifierTerm>(i)) ? rough[i] : 0;
  }
  for (std::size_t k = 0; k < weights.products.size(); ++k)
    weights.products[k].weight = full[kClassifierTerms + static_cast<Eigen::Index>(k)];
  return weights;
}

DriveScore scoreOf(const LabelledDrive& drive, const Weights& weights, bool leftOut) {
  DriveScore score{drive.name, drive.sensor, drive.real, leftOut};
  const auto n = static_cast<Eigen::Index>(drive.candidates.size());
  Eigen::VectorXd builtIn(n), odds(n), labels(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const LabelledCandidate& each = drive.candidates[static_cast<std::size_t>(i)];
    builtIn[i] = poleOdds(each.features);
    odds[i] = weights.odds(each.features);
    labels[i] = each.pole;
    score.poles += each.pole;
  }
  const Eigen::VectorXd alike = Eigen::VectorXd::Ones(n);
  score.candidates = drive.candidates.size();
  score.builtInLoss = logLoss(builtIn, labels, alike);
  score.loss = logLoss(odds, labels, alike);
  score.builtInPrecision = averagePrecision(builtIn, labels, alike);
  score.precision = averagePrecision(odds, labels, alike);
  return score;
}

std::string number(double value) {
  return io::significant(value, 6);
}

constexpr const char* kWrittenBy =
    "written by pole-eval train\n# (share/experiments/train-classifier.sh).\n";

void writeClassifier(const std::filesystem::path& file, const Weights& weights) {
  io::AtomicFile out(file);
  out.stream() << "# Weights of PoleClassifier, " << kWrittenBy
               << "# Rows \"a*b\": products of two terms brought to mean 0 and variance 1, and "
                  "their weight.\nterm,mean,scale,full,rough\n";
  for (int i = 0; i < kClassifierTerms; ++i)
    out.stream() << name(static_cast<ClassifierTerm>(i)) << ',' << number(weights.mean[i]) << ','
                 << number(weights.scale[i]) << ',' << number(weights.full[i]) << ','
                 << number(weights.rough[i]) << '\n';
  for (const Weights::Product& p : weights.products)
    out.stream() << name(static_cast<ClassifierTerm>(p.a)) << '*'
                 << name(static_cast<ClassifierTerm>(p.b)) << ',' << number(p.weight) << '\n';
  out.commit();
}

/// Fits the scale of the covariances to the poles with a known error that the weights accept.
Eigen::VectorXd fitCovariance(const std::vector<Sample>& samples, const Weights& weights) {
  constexpr double kFarError = 100;  // of no pole's own centre: another thing beside it
  std::vector<CovarianceTerms> terms;
  std::vector<double> errors, sampleWeights;
  for (const Sample& sample : samples) {
    const LabelledCandidate& each = *sample.candidate;
    const double odds = weights.odds(each.features);
    if (!each.pole || !each.squaredError || odds < 0 || *each.squaredError > kFarError) continue;
    terms.push_back(covarianceTerms(each.features, odds, each.columnAngle));
    errors.push_back(*each.squaredError);
    sampleWeights.push_back(sample.weight);
  }
  const auto n = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd design(n, kCovarianceTerms);
  for (Eigen::Index k = 0; k < n; ++k)
    for (int i = 0; i < kCovarianceTerms; ++i)
      design(k, i) = terms[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
  constexpr double kSmallRidge = 1e-3;
  return fitCovarianceScale(design, Eigen::Map<Eigen::VectorXd>(errors.data(), n),
                            Eigen::Map<Eigen::VectorXd>(sampleWeights.data(), n), kSmallRidge);
}

void writeCovariance(const std::filesystem::path& file, const Eigen::VectorXd& fitted) {
  io::AtomicFile out(file);
  out.stream() << "# Log-linear scale of the covariance of poles, " << kWrittenBy
               << "term,weight\n";
  for (int i = 0; i < kCovarianceTerms; ++i)
    out.stream() << name(static_cast<CovarianceTerm>(i)) << ',' << number(fitted[i]) << '\n';
  out.commit();
}

std::vector<LabelledDrive> readAll(const std::vector<std::filesystem::path>& files) {
  std::vector<LabelledDrive> drives;
  drives.reserve(files.size());
  for (const auto& file : files) drives.push_back(readCandidates(file));
  return drives;
}

Json reportOf(const std::vector<DriveScore>& scores, const TrainOptions& options) {
  Json drives = Json::array();
  for (const DriveScore& s : scores)
    drives.push_back(
        {{"drive", s.drive},
         {"sensor", s.sensor},
         {"real", s.real},
         {"left_out", s.leftOut},
         {"candidates", s.candidates},
         {"poles", s.poles},
         {"built_in", {{"log_loss", s.builtInLoss}, {"precision", s.builtInPrecision}}},
         {"new", {{"log_loss", s.loss}, {"precision", s.precision}}}});
  return {{"ridge", options.ridge},
          {"products", options.products},
          {"real_weight", options.realWeight},
          {"drives", drives}};
}

}  // namespace

std::vector<DriveScore> trainClassifier(const TrainOptions& options) {
  const std::vector<LabelledDrive> drives = readAll(options.candidates);
  const std::vector<LabelledDrive> tests = readAll(options.test);
  const std::vector<Sample> all = samplesOf(drives, options.realWeight);
  const Weights weights = fit(all, options);
  std::optional<Eigen::VectorXd> covariance;
  if (options.covariance) covariance = fitCovariance(all, weights);
  std::vector<DriveScore> scores;
  if (options.crossValidate && drives.size() > 1)
    for (std::size_t d = 0; d < drives.size(); ++d)
      scores.push_back(
          scoreOf(drives[d], fit(samplesOf(drives, options.realWeight, d), options), true));
  for (const LabelledDrive& drive : tests) scores.push_back(scoreOf(drive, weights, false));
  writeClassifier(options.classifier, weights);
  if (covariance) writeCovariance(*options.covariance, *covariance);
  if (options.json) writeJson(*options.json, reportOf(scores, options));
  return scores;
}

}  // namespace polemcl::apps
