#pragma once
/// \file BatchInputs.h
/// \brief The files that a batch needs before anything is done.

#include <string>

#include "batch/BatchSpec.h"
#include "cli/Settings.h"

namespace polemcl::apps {

/// \brief What is wrong with a session's input; empty when nothing is.
/// \param scored Whether its true poles (truthMap) are needed as well.
std::string inputObstacle(const BatchSession& session, bool scored);

/// \brief A file that settings name: beside the batch if it is there, else as the programs find it.
std::string besideBatch(const BatchSpec& spec, const std::string& file);

/// \brief The settings of a configuration. \throws Error as loadSettings(), naming batch and
/// configuration, and when its config is not there.
AllSettings settingsFor(const BatchSpec& spec, const BatchConfiguration& configuration);

/// \brief Reads the published figures of a batch, if it has any. \throws Error as
/// report::readPublishedSessions(), naming batch and key.
void requirePublished(const BatchSpec& spec);

}  // namespace polemcl::apps
