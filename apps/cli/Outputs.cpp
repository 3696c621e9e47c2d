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

struct NamedFile {
  std::string option;
  fs::path file;
};

/// Whether the new map takes the place of the one that it continues or converts.
bool continues(const NamedFile& out, const NamedFile& in) {
  return out.option == "--output" &&
         (in.option == "--add" || in.option == "--map" || in.option == "input");
}

bool isSame(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored) || fs::weakly_canonical(fs::absolute(a), ignored) ==
                                              fs::weakly_canonical(fs::absolute(b), ignored);
}

/// What an option names, and what is written beside it.
std::vector<NamedFile> namedBy(const CLI::Option& option, const std::vector<std::string>& beside) {
  std::vector<NamedFile> files;
  for (const std::string& value : option.results()) {
    const std::string stem = (fs::path(value).parent_path() / fs::path(value).stem()).string();
    files.push_back({option.get_name(), value});
    for (const std::string& name : beside) files.push_back({option.get_name(), stem + name});
  }
  return files;
}

struct Files {
  std::vector<NamedFile> read, written;
};

Files filesOf(const CLI::App& cli) {
  Files files;
  std::vector<const CLI::App*> apps{&cli};
  for (const CLI::App* command : cli.get_subcommands()) apps.push_back(command);
  for (const CLI::App* app : apps)
    for (const CLI::Option* option : app->get_options()) {
      const std::string type = option->get_type_name();
      const auto output = outputs().find(option);
      const bool isWritten = output != outputs().end();
      if (!isWritten && type != "FILE" && type != "FOLDER" && type != "INI") continue;
      auto& list = isWritten ? files.written : files.read;
      for (auto& file : namedBy(*option, isWritten ? output->second : std::vector<std::string>()))
        list.push_back(std::move(file));
    }
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
  const Files files = filesOf(cli);
  for (std::size_t i = 0; i < files.written.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (isSame(files.written[i].file, files.written[k].file))
        throw CLI::ValidationError(files.written[i].file.string(), "is given for two outputs");
}

void requireInputsKept(const CLI::App& cli) {
  const Files files = filesOf(cli);
  for (const auto& out : files.written)
    for (const auto& in : files.read)
      if (!continues(out, in) && isSame(out.file, in.file))
        throw Error(out.option + " " + out.file.string() + ": is an input (" + in.option +
                    "); give another name");
}

}  // namespace polemcl::apps
