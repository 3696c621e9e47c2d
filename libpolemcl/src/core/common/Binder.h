#pragma once
/// \file Binder.h
/// \brief Each setting named once: key, range, unit, comment and tier. Reading, writing, checking
/// and the reference page all follow from that one line.

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Allowed values of a number. NaN and infinities are never allowed.
struct POLEMCL_EXPORT Range {
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
  /// \brief The lower end excluded.
  static Range aboveUpTo(double min, double max) { return {min, max, true, false}; }
  bool contains(double value) const;
  std::string text() const;  ///< e.g. "> 0", "0 to 1", "any number"
};

/// \brief Who touches a setting.
enum class Tier {
  sensor,  ///< to be set for each sensor, mounting and vehicle
  tuning,  ///< worth a try when results are not good enough
  expert   ///< the measured value serves everywhere; change it only to study the method
};

/// \brief The words of the reference page.
POLEMCL_EXPORT const char* name(Tier tier);

/// \brief What a `bind` function talks to: it names every field of an option struct once. A value
/// that is out of range is refused, whether it was read or stood in the struct before.
class POLEMCL_EXPORT Binder {
 public:
  virtual ~Binder() = default;
  /// \brief The keys that follow belong to `[name]` and to the tier. A section may be opened again
  /// later; its first comment counts.
  void section(std::string_view name, std::string_view comment, Tier tier = Tier::tuning);
  /// \brief The keys that follow belong to this tier.
  void tier(Tier tier) { m_tier = tier; }

  void number(std::string_view key, double& field, const Range& allowed, std::string_view unit,
              std::string_view comment);
  /// \brief Whole numbers of any integer type.
  template <class Int>
  void integer(std::string_view key, Int& field, const Range& allowed, std::string_view unit,
               std::string_view comment);
  /// \brief Degrees in the file, radians in the field. \param allowed In degrees.
  void angleDeg(std::string_view key, double& field, const Range& allowed,
                std::string_view comment);
  void flag(std::string_view key, bool& field, std::string_view comment);
  /// \brief One of some words.
  void choice(std::string_view key, std::string& field, const std::vector<std::string>& allowed,
              std::string_view comment);
  template <class Enum>
  void choice(std::string_view key, Enum& field,
              const std::vector<std::pair<Enum, std::string>>& allowed, std::string_view comment);
  /// \brief Free text on one line, may be empty.
  void text(std::string_view key, std::string& field, std::string_view comment);
  /// \brief Numbers separated by blanks; an empty list is allowed.
  void numbers(std::string_view key, std::vector<double>& field, const Range& allowed,
               std::string_view unit, std::string_view comment);
  /// \brief As many numbers as there are fields.
  void numbers(std::string_view key, std::initializer_list<double*> fields, const Range& allowed,
               std::string_view unit, std::string_view comment);
  /// \brief Degrees in the file, radians in the field. \param allowed In degrees.
  void anglesDeg(std::string_view key, std::vector<double>& field, const Range& allowed,
                 std::string_view comment);

  /// \brief A rule between fields of the open section.
  /// \param allowed What is allowed for the key, in words.
  /// \throws Error naming section, key, value and what is allowed, unless `good`.
  void require(bool good, std::string_view key, double value, std::string_view allowed) const;
  void require(bool good, std::string_view key, std::string_view value,
               std::string_view allowed) const;

 protected:
  /// \brief What is known of a key besides its value.
  struct Key {
    std::string name, unit, allowed, comment;
    Tier tier = Tier::tuning;
  };
  Binder() = default;
  virtual void openSection(const std::string& comment) = 0;
  /// \brief Hands over the current value; returns the text to put in its place, if any.
  virtual std::optional<std::string> exchange(const Key& key, const std::string& current) = 0;
  virtual std::string place() const = 0;  ///< "file: " for messages
  /// \brief true: values are checked as they are, exchange() is never called.
  virtual bool onlyChecks() const { return false; }

  std::string m_section;

 private:
  /// Numbers of one key: any number of them, or `count`.
  struct Numbers {
    std::string_view key, unit, comment;
    const Range& allowed;  ///< in degrees where they are angles
    std::optional<std::size_t> count;
    bool degrees;
  };
  void bindNumbers(const Numbers& setting, std::vector<double>& field);
  void integer(std::string_view key, long long& field, const Range& allowed, const Range& fits,
               std::string_view unit, std::string_view comment);
  Key known(std::string_view key, std::string_view unit, std::string allowed,
            std::string_view comment) const;
  [[noreturn]] void refuse(std::string_view key, std::string_view value, std::string_view type,
                           std::string_view allowed, std::string_view unit,
                           std::string_view comment) const;

  Tier m_tier = Tier::tuning;
};

/// \brief Refuses values out of range. Use checkOptions().
class POLEMCL_EXPORT CheckingBinder : public Binder {
 protected:
  void openSection(const std::string&) override {}
  std::optional<std::string> exchange(const Key&, const std::string&) override {
    return std::nullopt;
  }
  std::string place() const override { return ""; }
  bool onlyChecks() const override { return true; }
};

/// \brief Checks an option struct: its `bind` function in checking mode.
/// \throws Error `[section] key = value: allowed is …`, with the names and units of the INI.
template <class Options>
void checkOptions(Options options) {
  CheckingBinder binder;
  bind(binder, options);
}

template <class Int>
void Binder::integer(std::string_view key, Int& field, const Range& allowed, std::string_view unit,
                     std::string_view comment) {
  Range fits = allowed;  // never more than the field can hold
  const auto least = static_cast<double>(std::numeric_limits<Int>::lowest());
  const auto most = static_cast<double>(std::numeric_limits<Int>::max());
  if (fits.min < least) fits.min = least;
  if (fits.max > most) fits.max = most;
  auto value = static_cast<long long>(field);
  integer(key, value, allowed, fits, unit, comment);
  field = static_cast<Int>(value);
}

template <class Enum>
void Binder::choice(std::string_view key, Enum& field,
                    const std::vector<std::pair<Enum, std::string>>& allowed,
                    std::string_view comment) {
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

}  // namespace polemcl
