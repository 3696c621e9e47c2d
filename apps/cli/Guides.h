#pragma once
/// \file Guides.h
/// \brief Examples of the programs, and what to do after them: for `--help` and the man pages.

#include <map>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief What helps a user to begin and to go on.
struct Guide {
  std::vector<std::string> examples;  ///< commands to type; tests parse them
  std::string next;                   ///< one sentence or two
};

/// \brief All guides, by program and subcommand: `pole-map`, `pole-map build`.
const std::map<std::string, Guide>& guides();
/// \brief The guide of a command, or an empty one.
const Guide& guideOf(const std::string& name);

}  // namespace polemcl::apps
