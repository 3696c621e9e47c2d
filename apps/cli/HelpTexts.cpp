/// \file HelpTexts.cpp
/// \brief Writes what the programs say of themselves, by their declared options: help texts (for
/// main.cpp), man pages, completion for bash. The build runs it.
/// Usage: write-help-texts FOLDER DATE   DATE: of the man pages, YYYY-MM-DD
/// Into FOLDER: polemcl/help/*.txt, man/man1/*.1, bash-completion/completions/*

#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "cli/CommandLine.h"
#include "cli/Completion.h"
#include "cli/ManPage.h"
#include "cli/OptionText.h"
#include "cli/Programs.h"

namespace {

namespace fs = std::filesystem;
using namespace polemcl::apps;

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// What is written of one program or subcommand.
void writePages(const CLI::App& app, const std::string& name, const std::string& help,
                const fs::path& folder, const std::string& date, std::string& rows) {
  const std::string page = manPageName(name);
  write(folder / "polemcl" / "help" / (page + ".txt"), help);
  write(folder / "man" / "man1" / (page + ".1"), manPage(app, name, date));
  rows += completionRow(app, name);
}

void writeAll(const fs::path& folder, const std::string& date) {
  std::string rows;
  std::vector<std::string> names;
  for (const Program& program : programs())
    visitOptions(program.main, program.name, [&](CLI::App& cli) {
      const std::string name = names.emplace_back(program.name);
      writePages(cli, name, cli.help(), folder, date, rows);
      for (const CLI::App* command : subcommandsOf(cli))
        writePages(*command, name + ' ' + command->get_name(), command->help(name), folder, date,
                   rows);
    });
  const fs::path completions = folder / "bash-completion" / "completions";
  write(completions / "polemcl", completion(names, rows));
  for (const std::string& name : names) {  // bash looks for the name of the program
    fs::remove(completions / name);
    fs::create_symlink("polemcl", completions / name);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    writeAll(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "write-help-texts: " << e.what() << '\n';
    return 1;
  }
}
