#pragma once
/// \file BatchCommands.h
/// \brief Command lines of the tasks of a batch; files are named from the task's own folder.

#include <string>
#include <vector>

#include "batch/BatchSpec.h"

namespace polemcl::apps {

using Command = std::vector<std::string>;

/// \brief Files of a score task, one for each way to count; see scoreCommands().
inline constexpr const char* scoreFiles[] = {"near_1m.json", "one_to_one_1m.json",
                                             "one_to_one_0.5m.json"};

/// \brief The program, quiet, on one thread: one process runs for each core.
Command program(const std::string& name);
/// \brief The text as one word of a shell's command line.
std::string shellQuoted(const std::string& text);
void append(Command& command, const Command& more);

/// \brief The dataset of a session to `SESSION.rawlog`. \param seed Seed of the whole batch.
Command importCommand(const BatchSession& session, std::uint32_t seed);
/// \brief The poles that SemanticKITTI's labels show, to `truth.polemap`.
Command labelsCommand(const BatchSession& session);
/// \brief Scores a map, to scoreFiles in their order: map poles within 1 m of a true one, as the
/// authors count, then one to one within 1 m and within 0.5 m.
std::vector<Command> scoreCommands(const std::string& map, const std::string& truth);

}  // namespace polemcl::apps
