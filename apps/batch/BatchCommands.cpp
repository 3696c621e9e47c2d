#include "batch/BatchCommands.h"

namespace polemcl::apps {

Command program(const std::string& name) {
  return {name, "--quiet", "--threads", "1"};
}

std::string shellQuoted(const std::string& text) {
  if (!text.empty() && text.find_first_of(" \t\n'\"\\$&|;<>()*?[]#~`!{}") == std::string::npos)
    return text;
  std::string quote = "'";
  for (const char c : text) quote += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quote + "'";
}

void append(Command& command, const Command& more) {
  command.insert(command.end(), more.begin(), more.end());
}

Command importCommand(const BatchSession& session, std::uint32_t seed) {
  Command command = program("pole-import");
  append(command,
         {session.source, "--input", session.input, "--output", session.name + ".rawlog", "--every",
          std::to_string(session.every), "--offset", std::to_string(session.offset)});
  if (session.odometryNoise > 0)
    append(command, {"--odometry-noise", std::to_string(session.odometryNoise), "--seed",
                     std::to_string(seedOf(seed, session.name + "/odometry"))});
  if (!session.sensorPose.empty()) append(command, {"--sensor-pose", session.sensorPose});
  if (!session.poses.empty())
    append(command, {"--poses", session.poses, "--poses-of", session.posesOf});
  if (!session.calib.empty()) append(command, {"--calib", session.calib});
  return command;
}

Command labelsCommand(const BatchSession& session) {
  Command command = program("pole-labels");
  append(command, {"--input", session.input, "--output", "truth.polemap"});
  return command;
}

std::vector<Command> scoreCommands(const std::string& map, const std::string& truth) {
  const Command ways[] = {
      {"--radius", "1"}, {"--radius", "1", "--one-to-one"}, {"--radius", "0.5", "--one-to-one"}};
  std::vector<Command> commands;
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    Command command = program("pole-eval");
    append(command, {"map", "--truth", truth, "--map", map, "--json", scoreFiles[i]});
    append(command, ways[i]);
    commands.push_back(command);
  }
  return commands;
}

}  // namespace polemcl::apps
