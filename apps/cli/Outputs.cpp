#include "cli/Outputs.h"

#include <filesystem>
#include <map>

#include <polemcl/core/common/Types.h>

namespace polemcl::apps {
namespace {

namespace fs = std::filesystem;

std::map<const CLI::Option*, std::vector<std::string>>& outputs() {
  static std::map<const CLI::Option*, std::vector<std::string>> options;
  return options;
}

/// A file that the command line names.
struct NamedFile {
  std::string option;
  fs::path file;
  bool isWritten;
};

/// Whether the new map takes the place of the one that it continues or converts.
bool continues(const NamedFile& out, const NamedFile& in) {
  return out.option == "--output" &&
         (in.option == "--add" || in.option == "--map" || in.option == "input");
}

bool isSame(const NamedFile& a, const NamedFile& b) {
  std::error_code ignored;
  return fs::equivalent(a.file, b.file, ignored) ||
         fs::weakly_canonical(fs::absolute(a.file), ignored) ==
             fs::weakly_canonical(fs::absolute(b.file), ignored);
}

/// Adds what an option names, and what is written beside it.
void addFilesOf(const CLI::Option& option, std::vector<NamedFile>& files) {
  const std::string type = option.get_type_name();
  const auto output = outputs().find(&option);
  const bool isWritten = output != outputs().end();
  if (!isWritten && type != "FILE" && type != "FOLDER" && type != "INI") return;
  for (const std::string& value : option.results()) {
    files.push_back({option.get_name(), value, isWritten});
    if (!isWritten) continue;
    const std::string stem = (fs::path(value).parent_path() / fs::path(value).stem()).string();
    for (const std::string& end : output->second)
      files.push_back({option.get_name(), stem + end, isWritten});
  }
}

std::vector<NamedFile> filesOf(const CLI::App& cli) {
  std::vector<NamedFile> files;
  for (const CLI::Option* option : cli.get_options()) addFilesOf(*option, files);
  for (const CLI::App* command : cli.get_subcommands())
    for (const CLI::Option* option : command->get_options()) addFilesOf(*option, files);
  return files;
}

}  // namespace

void forgetOutputs() {
  outputs().clear();
}

CLI::Option* markOutput(CLI::Option* option, const std::vector<std::string>& beside) {
  outputs()[option] = beside;
  return option;
}

void requireDistinctOutputs(const CLI::App& cli) {
  const auto files = filesOf(cli);
  for (auto a = files.begin(); a != files.end(); ++a)
    for (auto b = files.begin(); b != a; ++b)
      if (a->isWritten && b->isWritten && isSame(*a, *b))
        throw CLI::ValidationError(a->file.string(), "is given for two outputs");
}

void requireInputsKept(const CLI::App& cli) {
  const auto files = filesOf(cli);
  for (const auto& out : files)
    for (const auto& in : files)
      if (out.isWritten && !in.isWritten && !continues(out, in) && isSame(out, in))
        throw Error(out.option + " " + out.file.string() + ": is an input (" + in.option +
                    "); give another name");
}

}  // namespace polemcl::apps
