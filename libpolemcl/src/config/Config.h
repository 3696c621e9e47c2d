#pragma once
/// \file Config.h
/// \brief Strict INI files: one function per option struct serves both reading and writing.
///
/// Grammar: as in MRPT's `CConfigFileMemory` (`[section]`, `key = value`, `@define`, `$env{}`);
/// names are not case sensitive. `#`, `;` and `//` start a comment at the start of a line or after
/// a blank. Cases that MRPT ignores silently are an Error here: unknown sections and keys, repeated
/// keys and sections, other lines, values of the wrong type or out of range.

#include <mrpt/config/CConfigFileBase.h>

#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/common/Types.h"

namespace polemcl {

/// \brief Allowed values of a number. NaN and infinities are never allowed.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool openMin = false;  ///< true: min itself is not allowed
  bool openMax = false;  ///< true: max itself is not allowed

  static Range any() { return {}; }
  static Range atLeast(double min) { return {min, any().max, false, false}; }
  static Range above(double min) { return {min, any().max, true, false}; }
  static Range between(double min, double max) { return {min, max, false, false}; }
  /// \brief Both ends excluded.
  static Range inside(double min, double max) { return {min, max, true, true}; }
  bool contains(double value) const;
  std::string text() const;  ///< e.g. "> 0", "0 to 1", "any number"
};

/// \brief Interface for `bind` functions, which name every field of an option struct once. A reader
/// sets the fields whose keys are present and leaves the others at their defaults. A writer writes
/// all fields.
class Binder {
 public:
  virtual ~Binder() = default;
  /// \brief The following keys belong to `[name]`. A section may be opened again later.
  void section(const std::string& name, const std::string& comment);

  void number(const std::string& key, double& field, const Range& allowed, const std::string& unit,
              const std::string& comment);
  /// \brief Whole numbers of any integer type.
  template <class Int>
  void integer(const std::string& key, Int& field, const Range& allowed, const std::string& unit,
               const std::string& comment);
  /// \brief Degrees in the file, radians in the field. \param allowed In degrees.
  void angleDeg(const std::string& key, double& field, const Range& allowed,
                const std::string& comment);
  void flag(const std::string& key, bool& field, const std::string& comment);
  /// \brief One of the allowed words.
  void choice(const std::string& key, std::string& field, const std::vector<std::string>& allowed,
              const std::string& comment);
  template <class Enum>
  void choice(const std::string& key, Enum& field,
              const std::vector<std::pair<Enum, std::string>>& allowed, const std::string& comment);
  /// \brief Free text on one line, may be empty.
  void text(const std::string& key, std::string& field, const std::string& comment);
  /// \brief Numbers separated by blanks; the list may be empty.
  void numbers(const std::string& key, std::vector<double>& field, const Range& allowed,
               const std::string& unit, const std::string& comment);
  /// \brief As many numbers as fields.
  void numbers(const std::string& key, std::initializer_list<double*> fields, const Range& allowed,
               const std::string& unit, const std::string& comment);
  /// \brief Degrees in the file, radians in the field. \param allowed In degrees.
  void anglesDeg(const std::string& key, std::vector<double>& field, const Range& allowed,
                 const std::string& comment);
  /// \brief Last line of a `bind` function: calls `options.validate()`. An Error gets file and
  /// section.
  template <class Options>
  void check(const Options& options);

 protected:
  /// \brief Description of a key, without its value.
  struct Key {
    std::string name, unit, allowed, comment;
  };
  virtual void openSection(const std::string& comment) = 0;
  /// \brief Passes the current value; returns the text that replaces it, if any.
  virtual std::optional<std::string> exchange(const Key& key, const std::string& current) = 0;
  virtual std::string place() const = 0;  ///< "file: " for messages

  std::string m_section;

 private:
  void number(const Key& key, double& field, const Range& allowed);
  void integer(const Key& key, long long& field, const Range& allowed);
  [[noreturn]] void refuse(const Key& key, const std::string& value, const std::string& type) const;
  [[noreturn]] void refuseStruct(const std::string& what) const;
};

/// \brief An INI file in memory, checked for errors that MRPT's parser ignores silently.
class ConfigFile {
 public:
  /// \throws Error when the file cannot be read, a line is not a section, key or comment, or a
  ///         section or key is given twice (the message names both lines).
  static ConfigFile read(const std::string& path);
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
  std::shared_ptr<mrpt::config::CConfigFileBase> m_source;
};

/// \brief Fills option structs. Bind every struct that the programs know, then call finish():
/// \code
///   ConfigReader reader(ConfigFile::read(path));
///   bind(reader, settings.sensor);
///   bind(reader, settings.extraction);
///   reader.finish();
/// \endcode
class ConfigReader : public Binder {
 public:
  explicit ConfigReader(const ConfigFile& file);
  /// \brief Reads one section of a source that belongs to others (a map definition of MRPT).
  /// Section names of the bind functions are ignored; all keys are searched in `fixedSection`.
  ConfigReader(const mrpt::config::CConfigFileBase& source, const std::string& name,
               const std::string& fixedSection);
  /// \brief Known keys of the open section that other code reads.
  void knownElsewhere(std::initializer_list<std::string> keys);
  /// \throws Error on a section or key that was not bound, with the known ones.
  void finish() const;

 protected:
  void openSection(const std::string& comment) override;
  std::optional<std::string> exchange(const Key& key, const std::string& current) override;
  std::string place() const override;

 private:
  std::shared_ptr<const mrpt::config::CConfigFileBase> m_owned;
  const mrpt::config::CConfigFileBase* m_source;
  std::string m_name;
  std::string m_fixedSection;  ///< empty: sections as in the bind functions
  std::map<std::string, std::set<std::string>> m_known;  ///< lower case: section -> keys
};

/// \brief Writes option structs, every key with unit, allowed values and meaning. The text is read
/// back as the same struct, bit for bit.
class ConfigWriter : public Binder {
 public:
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
  std::vector<Section> m_sections;
  std::size_t m_open = 0;  ///< index of the open section
};

template <class Int>
void Binder::integer(const std::string& key, Int& field, const Range& allowed,
                     const std::string& unit, const std::string& comment) {
  Range fits = allowed;  // limited to the field's type
  const auto least = static_cast<double>(std::numeric_limits<Int>::lowest());
  const auto most = static_cast<double>(std::numeric_limits<Int>::max());
  if (fits.min < least) fits.min = least;
  if (fits.max > most) fits.max = most;
  auto value = static_cast<long long>(field);
  integer(Key{key, unit, allowed.text(), comment}, value, fits);
  field = static_cast<Int>(value);
}

template <class Enum>
void Binder::choice(const std::string& key, Enum& field,
                    const std::vector<std::pair<Enum, std::string>>& allowed,
                    const std::string& comment) {
  std::vector<std::string> words;
  std::string word;
  for (const auto& [value, name] : allowed) {
    words.push_back(name);
    if (value == field) word = name;
  }
  choice(key, word, words, comment);
  for (const auto& [value, name] : allowed)
    if (name == word) field = value;
}

template <class Options>
void Binder::check(const Options& options) {
  try {
    options.validate();
  } catch (const Error& error) {
    refuseStruct(error.what());
  }
}

}  // namespace polemcl
