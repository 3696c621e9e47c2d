#pragma once
/// \file Config.h
/// \brief Strict INI files: the reader and the writer for the `bind` functions of option structs.
///
/// Grammar: as in MRPT's `CConfigFileMemory` (`[section]`, `key = value`, `@define`), but without
/// `$eval{}`, which is a program, and `$env{}`, which reads what is no part of the file; names are
/// not case sensitive. `#`, `;` and `//` start a comment at the start of a line or after a blank.
/// Cases that MRPT ignores silently are an Error here: unknown sections and keys, repeated keys and
/// sections, other lines, values of the wrong type or out of range.

#include <mrpt/config/CConfigFileBase.h>

#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <polemcl/export.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief An INI file in memory, checked for what MRPT's parser passes over in silence.
class POLEMCL_EXPORT ConfigFile {
 public:
  /// \throws Error when the file cannot be read, a line is not a section, key or comment, or a
  ///         section or key is given twice (the message names both lines).
  /// \param path As it is, or from the working folder.
  static ConfigFile read(const std::string& path);
  /// \brief As read(), and a name that is no file there is looked for among the installed settings:
  /// `hdl32e.ini`. They lie in `share/polemcl/config`, beside the program's folder, above the
  /// library, or where the library was configured to be installed.
  static ConfigFile readInstalled(const std::string& pathOrName);
  /// \param name Name of the file in messages.
  static ConfigFile fromText(const std::string& text, const std::string& name);

  /// \brief Replaces or adds a value. \param assignment `section.key=value`, the key without a dot.
  /// \throws Error when it does not have that form. Section, key and value are checked later, when
  ///         the file is bound.
  void set(const std::string& assignment);

  const std::string& name() const { return m_name; }
  const mrpt::config::CConfigFileBase& source() const { return *m_source; }

 private:
  friend class ConfigReader;
  ConfigFile() = default;
  std::string m_name;
  bool m_changed = false;  ///< by set()
  std::shared_ptr<mrpt::config::CConfigFileBase> m_source;
};

/// \brief Fills option structs. Bind every struct that you use, then call finish(). A struct that
/// is not bound keeps its defaults, whatever the file says: \code
///   ConfigReader reader(ConfigFile::read(path));
///   bind(reader, settings.sensor);
///   bind(reader, settings.extraction);
///   reader.finish();
/// \endcode
class POLEMCL_EXPORT ConfigReader : public Binder {
 public:
  explicit ConfigReader(const ConfigFile& file);
  /// \brief Reads one section of a source that belongs to others (a map definition of MRPT).
  /// Section names of the bind functions are ignored; all keys are searched in `fixedSection`.
  ConfigReader(const mrpt::config::CConfigFileBase& source, const std::string& name,
               const std::string& fixedSection);
  /// \brief Known keys of the open section that other code reads.
  void knownElsewhere(std::initializer_list<std::string> keys);
  /// \brief Checks that nothing in the file was passed over by mistake.
  /// \param others Sections of other programs, in lower case; they are not looked into.
  /// \throws Error on an unknown key or section, with the known ones. Settings that version 1 had
  ///         are passed over if they have the value that is fixed now.
  void finish(const std::set<std::string>& others = {}) const;
  /// \brief The messages of all errors that finish() could throw; empty: none.
  std::vector<std::string> unknownEntries(const std::set<std::string>& others = {}) const;

 protected:
  void openSection(const std::string& comment) override;
  std::optional<std::string> exchange(const Key& key, const std::string& current) override;
  std::string place() const override;

 private:
  std::string unknownSection(const std::string& section, const std::set<std::string>& others) const;

  std::shared_ptr<const mrpt::config::CConfigFileBase> m_owned;
  const mrpt::config::CConfigFileBase* m_source;
  std::string m_name;
  std::string m_fixedSection;  ///< empty: sections as in the bind functions
  std::map<std::string, std::set<std::string>> m_known;  ///< lower case: section -> keys
};

/// \brief Writes option structs, every key with unit, allowed values and meaning. The text is read
/// back as the same struct, bit for bit.
class POLEMCL_EXPORT ConfigWriter : public Binder {
 public:
  /// \param most Keys of later tiers are left out.
  explicit ConfigWriter(Tier most = Tier::expert) : m_most(most) {}
  std::string text() const;
  /// \brief Writes the file atomically. \throws Error when it cannot be written.
  void save(const std::string& path) const;

 protected:
  void openSection(const std::string& comment) override;
  std::optional<std::string> exchange(const Key& key, const std::string& current) override;
  std::string place() const override;

 private:
  struct Section {
    std::string name, comment, lines;
  };
  Tier m_most;
  std::vector<Section> m_sections;
  std::size_t m_open = 0;  ///< index of the open section
};

}  // namespace polemcl
