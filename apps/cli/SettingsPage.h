#pragma once
/// \file SettingsPage.h
/// \brief The reference page of all settings, share/doc/settings.md, as made from the bindings.

#include <string>

namespace polemcl::apps {

/// \brief The page as Markdown: a table for each section, with key, default, allowed values, tier
/// and meaning.
std::string settingsPage();

}  // namespace polemcl::apps
