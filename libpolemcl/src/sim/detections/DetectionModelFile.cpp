#include <nlohmann/json.hpp>
#include <set>

#include "io/file/ErrorPlace.h"
#include "io/file/ParsedJson.h"
#include "sim/detections/DetectionModel.h"

namespace polemcl::sim {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "polemcl detection model 1";

/// One object of the file: returns its values, and reports keys that nobody asked for.
class Section {
 public:
  Section(const Json& json, std::string where) : m_json(json), m_where(std::move(where)) {
    if (!json.is_object()) throw Error(m_where + "an object {...} is needed");
  }

  const Json& get(const std::string& key) {
    m_asked.insert(key);
    const auto found = m_json.find(key);
    if (found == m_json.end()) throw Error(m_where + key + ": is missing");
    return *found;
  }
  bool has(const std::string& key) const { return m_json.contains(key); }
  double number(const std::string& key) {
    const Json& value = get(key);
    if (!value.is_number()) throw Error(m_where + key + ": a number is needed");
    return value.get<double>();
  }
  std::string text(const std::string& key) {
    const Json& value = get(key);
    if (!value.is_string()) throw Error(m_where + key + ": a text is needed");
    return value.get<std::string>();
  }
  std::vector<double> numbers(const std::string& key) { return numbers(get(key), key); }
  template <std::size_t n>
  std::array<double, n> array(const std::string& key) {
    return fixed<n>(get(key), key);
  }
  std::vector<Quantiles> rows(const std::string& key) {
    const Json& value = get(key);
    if (!value.is_array()) throw Error(m_where + key + ": a list of lists is needed");
    std::vector<Quantiles> rows;
    for (const Json& row : value) rows.push_back(fixed<kQuantileLevels.size()>(row, key));
    return rows;
  }
  Section section(const std::string& key) { return {get(key), m_where + key + "."}; }
  NoiseSpectrum spectrum(const std::string& key) {
    Section part = section(key);
    NoiseSpectrum spectrum;
    spectrum.always = part.array<5>("always");
    spectrum.today = part.array<5>("today");
    part.finish();
    return spectrum;
  }
  void finish() const {
    for (const auto& [key, value] : m_json.items())
      if (m_asked.count(key) == 0) throw Error(m_where + key + ": is not known");
  }

 private:
  std::vector<double> numbers(const Json& value, const std::string& key) const {
    if (!value.is_array()) throw Error(m_where + key + ": a list of numbers is needed");
    std::vector<double> result;
    for (const Json& number : value) {
      if (!number.is_number())
        throw Error(m_where + key + ": holds something that is not a number");
      result.push_back(number.get<double>());
    }
    return result;
  }
  template <std::size_t n>
  std::array<double, n> fixed(const Json& value, const std::string& key) const {
    const auto values = numbers(value, key);
    if (values.size() != n)
      throw Error(m_where + key + ": " + std::to_string(n) + " numbers are needed, " +
                  std::to_string(values.size()) + " are there");
    std::array<double, n> result;
    std::copy(values.begin(), values.end(), result.begin());
    return result;
  }

  const Json& m_json;
  std::string m_where;
  std::set<std::string> m_asked;
};

void readClass(Section section, ClassModel& model, bool lasts) {
  if (lasts) model.detected = section.numbers("detected");
  for (int r = 0; r < kReported; ++r)
    model.reported[r] = section.rows(name(static_cast<Reported>(r)));
  section.finish();
}

SeasonModel readSeason(Section section) {
  SeasonModel season;
  season.snow = section.array<4>("snow");
  season.bare = section.array<4>("bare");
  season.fence = section.number("fence");
  season.siteClutter = section.number("site_clutter_per_m");
  section.finish();
  return season;
}

DetectionModel fromJson(const Json& json, const std::string& where) {
  Section file(json, where);
  if (file.text("format") != kFormat)
    throw Error(where + "format: only \"" + kFormat + "\" can be read");
  DetectionModel model;
  model.fittedOn = file.text("fitted_on");
  model.sensor = file.text("sensor");
  model.height = file.number("height_m");
  model.maxRange = file.number("max_range_m");
  const double points = file.number("points_per_scan");
  if (!(points >= 0 && points <= 1e9)) throw Error(where + "points_per_scan: 0 to 1e9 is allowed");
  model.points = static_cast<std::uint32_t>(points);
  model.behindHouses = file.number("behind_houses");
  model.errorExponent = file.number("error_exponent");
  model.detectedRange = file.numbers("detected_range_m");
  model.reportedRange = file.numbers("reported_range_m");
  if (file.array<kQuantileLevels.size()>("levels") != kQuantileLevels)
    throw Error(where + "levels: not the quantiles of this version; fit the model again");
  if (file.array<kNoiseReach.size()>("reach_m") != kNoiseReach)
    throw Error(where + "reach_m: not the reaches of this version; fit the model again");
  Section clutter = file.section("clutter_per_m");
  model.clutterAlways = clutter.number("always");
  model.clutterToday = clutter.number("today");
  clutter.finish();
  model.clutterLateral = file.array<kQuantileLevels.size()>("clutter_lateral_m");
  model.passing = file.number("passing_per_scan");
  model.passingRange = file.array<kQuantileLevels.size()>("passing_range_m");
  if (file.has("season")) model.season = readSeason(file.section("season"));
  Section persistence = file.section("persistence");
  model.poleVisibility = persistence.spectrum("poles");
  model.clutterVisibility = persistence.spectrum("clutter");
  for (int r = 0; r < kReported; ++r)
    model.noise[r] = persistence.spectrum(name(static_cast<Reported>(r)));
  persistence.finish();
  Section classes = file.section("classes");
  for (int c = 0; c < kDetectionClasses; ++c) {
    const auto detectionClass = static_cast<DetectionClass>(c);
    readClass(classes.section(name(detectionClass)), model.classes[c],
              detectionClass != DetectionClass::passing);
  }
  classes.finish();
  file.finish();
  return model;
}

}  // namespace

DetectionModel readDetectionModel(const std::filesystem::path& file) {
  const auto parsed = [&] {
    try {
      return io::parsedJson<Json>(file);
    } catch (const Json::exception&) {
      throw Error(file.string() + ": is not JSON");
    }
  };
  DetectionModel model = fromJson(parsed(), file.string() + ": ");
  io::located(file.string() + ": ", [&] { model.validate(); });
  return model;
}

}  // namespace polemcl::sim
