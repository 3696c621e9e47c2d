#pragma once
/// \file Fuzz.h
/// \brief What the fuzzers have in common: a target is a reader that gets arbitrary bytes.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace polemcl::fuzz {

/// \brief A reader under test. It may throw Error. All else that it throws is a finding, as is what
/// a sanitizer reports.
struct Target {
  const char* name;
  void (*read)(std::string_view bytes);
  std::vector<std::string> (*seeds)();  ///< whole inputs to begin with
};

/// \name The targets, by subject
/// @{
std::vector<Target> tableTargets();     ///< text: tables, trajectories
std::vector<Target> mapTargets();       ///< maps and inventories
std::vector<Target> settingTargets();   ///< INI files, batches, models
std::vector<Target> scanTargets();      ///< clouds
std::vector<Target> bagTargets();       ///< recordings of ROS 2
std::vector<Target> folderTargets();    ///< datasets
std::vector<Target> mrptTargets();      ///< archives and rawlogs
std::vector<Target> liveTargets();      ///< packets of sensors
std::vector<Target> receiverTargets();  ///< packets become turns
std::vector<Target> methodTargets();    ///< extraction, search and adjustment on arbitrary numbers
/// @}

/// \brief A folder of this process in memory. TMPDIR says where.
const std::filesystem::path& folder();

/// \brief Writes a file of that folder, in place of the one before. \param name May hold folders
/// that exist.
std::filesystem::path fileOf(const std::string& name, std::string_view bytes);

/// \brief The readers of a target that has several: the first byte of the input says which one gets
/// the rest.
using Readers = std::vector<std::function<void(std::string_view)>>;
void readWithOne(const Readers& readers, std::string_view bytes);
/// \brief An input for the reader of this number.
std::string inputFor(std::size_t reader, const std::string& rest);

/// \brief The pieces between the characters FS (ASCII 28, "file separator"): `most`, the last with
/// all that is left; fewer if there are not as many.
std::vector<std::string_view> pieces(std::string_view bytes, std::size_t most);
/// \brief The inverse of pieces().
std::string joined(const std::vector<std::string>& pieces);

/// \brief The content of a file that the programs made for the seeds (tests/fuzz/run.sh); empty if
/// it is not there.
std::string made(const std::string& name);

/// \brief Numbers out of arbitrary bytes; zeros after their end.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : m_bytes(bytes) {}
  bool atEnd() const { return m_bytes.empty(); }
  unsigned byte();
  float real();
  std::size_t left() const { return m_bytes.size(); }

 private:
  std::string_view m_bytes;
};

}  // namespace polemcl::fuzz
