#pragma once
// The reference pages of all settings, in share/doc.

#include <map>
#include <string>

namespace polemcl::apps {

/// \brief Names of files in share/doc and their Markdown. settings.md says what is where; each
/// other page has sections, as tables with key, default, allowed values, tier and meaning.
std::map<std::string, std::string> settingsPages();

}  // namespace polemcl::apps
