#include <mrpt/config/CConfigFile.h>

#include <iostream>

#include <polemcl/mrpt/common/Compatibility.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include "config/Config.h"
#include "core/common/Binder.h"

MAP_DEFINITION_REGISTER("polemcl::CPoleMap,poleMap", polemcl::CPoleMap)

namespace polemcl {

void bind(Binder& b, CPoleMap::TInsertionOptions& o) {
  b.section("insertion", "How CPoleMap inserts observations one by one (MRPT's tools)");
  b.number("merge_distance", o.mergeDistance, Range::above(0), "m",
           "a detection within this distance of a pole is that pole");
  b.number("min_confidence", o.minConfidence, Range::between(0, 1), "",
           "detections with a lower confidence are not inserted");
}

namespace {

using Source = mrpt::config::CConfigFileBase;

std::string nameOf(const Source& source) {
  const auto* file = dynamic_cast<const mrpt::config::CConfigFile*>(&source);
  return file ? file->getAssociatedFile() : "map options";
}

/// MRPT's own options pass over keys that they do not know; so do these, but they say it.
void warnOfUnknown(const ConfigReader& reader) {
  for (const std::string& text : reader.unknownEntries())
    std::cerr << "polemcl: warning: " + text + "; it is ignored\n";
}

/// Fills options from one section of a configuration that MRPT hands over.
template <class Options>
void load(const Source& source, const std::string& section, Options& options) {
  ConfigReader reader(source, nameOf(source), section);
  bind(reader, options);
  warnOfUnknown(reader);
}

/// Writes options to one section of an MRPT configuration.
class SourceWriter : public Binder {
 public:
  SourceWriter(Source& target, std::string section)
      : m_target(target), m_fixedSection(std::move(section)) {}

 protected:
  void openSection(const std::string&) override { m_section = m_fixedSection; }
  std::optional<std::string> exchange(const Key& key, const std::string& current) override {
    const std::string unit = key.unit.empty() ? "" : key.unit + "; ";
    m_target.write(m_section, key.name, current, -1, -1,
                   key.comment + " [" + unit + key.allowed + "]");
    return std::nullopt;
  }
  std::string place() const override { return nameOf(m_target) + ": "; }

 private:
  Source& m_target;
  std::string m_fixedSection;
};

template <class Options>
void save(Source& target, const std::string& section, Options options) {
  SourceWriter writer(target, section);
  bind(writer, options);
}

template <class Options>
void dump(std::ostream& out, Options options) {
  ConfigWriter writer;
  bind(writer, options);
  out << writer.text();
}

}  // namespace

void CPoleMap::TInsertionOptions::validate() const {
  checkOptions(*this);
}

void CPoleMap::TInsertionOptions::loadFromConfigFile(const Source& source,
                                                     const std::string& section) {
  load(source, section, *this);
}
void CPoleMap::TInsertionOptions::saveToConfigFile(Source& target,
                                                   const std::string& section) const {
  save(target, section, *this);
}
void CPoleMap::TInsertionOptions::dumpToTextStream(std::ostream& out) const {
  dump(out, *this);
}

CPoleMap::TLikelihoodOptions& CPoleMap::TLikelihoodOptions::operator=(
    const LikelihoodOptions& options) {
  LikelihoodOptions::operator=(options);
  return *this;
}
void CPoleMap::TLikelihoodOptions::loadFromConfigFile(const Source& source,
                                                      const std::string& section) {
  load(source, section, static_cast<LikelihoodOptions&>(*this));
}
void CPoleMap::TLikelihoodOptions::saveToConfigFile(Source& target,
                                                    const std::string& section) const {
  save(target, section, static_cast<const LikelihoodOptions&>(*this));
}
void CPoleMap::TLikelihoodOptions::dumpToTextStream(std::ostream& out) const {
  dump(out, static_cast<const LikelihoodOptions&>(*this));
}

CPoleMap::TMapDefinition::TMapDefinition() = default;

void CPoleMap::TMapDefinition::loadFromConfigFile_map_specific(
    const Source& source, const std::string& sectionNamePrefix) {
  ConfigReader reader(source, nameOf(source), sectionNamePrefix + "_creationOpts");
  reader.section("creation", "");
  reader.text("map_file", mapFile, "a .polemap to load");
  reader.knownElsewhere({"enableSaveAs3DObject", "enableObservationLikelihood",
                         "enableObservationInsertion"});  // genericMapParams, read by MRPT
  warnOfUnknown(reader);
  insertionOpts.loadFromConfigFile(source, sectionNamePrefix + "_insertOpts");
  likelihoodOpts.loadFromConfigFile(source, sectionNamePrefix + "_likelihoodOpts");
}

void CPoleMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  out << "map_file = " << mapFile << "\n";
  insertionOpts.dumpToTextStream(out);
  likelihoodOpts.dumpToTextStream(out);
}

CreatedMap CPoleMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& def) {
  const auto& own = dynamic_cast<const CPoleMap::TMapDefinition&>(def);
  auto map = std::make_unique<CPoleMap>();
  map->insertionOptions = own.insertionOpts;
  map->likelihoodOptions = own.likelihoodOpts;
  if (!own.mapFile.empty()) map->loadFromPoleMapFile(own.mapFile);
  return CreatedMap(map.release());
}

}  // namespace polemcl
