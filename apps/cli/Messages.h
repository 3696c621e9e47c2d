#pragma once
/// \file Messages.h
/// \brief What programs say on standard error besides progress: in colour for people, and in detail
/// with `--verbose`; how one that failed says why.

#include <exception>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace polemcl::apps {

/// \brief A text with question marks for what is no UTF-8, controls a terminal, or turns the
/// direction of text (files and sensors bring it along). Ends of lines and tabs stay.
std::string printable(std::string_view text);

/// \brief While it lives, a stream writes printable() text.
class PrintableOutput : public std::streambuf {
 public:
  explicit PrintableOutput(std::ostream& stream);
  ~PrintableOutput() override;
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 protected:
  int overflow(int next) override;
  int sync() override;

 private:
  std::ostream& m_stream;
  std::streambuf* m_target;
  std::string m_text;  ///< not written yet
};

/// \brief True when standard error is a terminal.
bool errorsAreOnTerminal();

/// \brief Colours of a terminal.
enum class Colour { red, yellow, green };
/// \brief A text for standard error in a colour. Without a terminal, with `TERM=dumb` or with a
/// non-empty `NO_COLOR` in the environment: the text as it is.
std::string coloured(Colour colour, const std::string& text);

/// \brief The line "pole-map: warning: <text>".
std::string warningLine(const std::string& program, const std::string& text);

/// \brief From now on, sayDetail() writes its lines in the name of a program; or not.
void setVerbose(const std::string& program, bool verbose);
/// \brief With `--verbose`, the line "pole-map: <text>".
void sayDetail(const std::string& text);

/// \brief Time and memory that the process took, such as `3.2 s, at most 120 MB of memory`.
std::string resourcesTaken(double seconds);

/// \brief What an exception says, in words for people where memory or threads are missing.
std::string reasonOf(const std::exception& error);

/// \brief Writes "PROGRAM: TEXT" to standard error.
void sayFailure(const std::string& program, const std::string& text);

/// \brief From now on, an exception that nobody can catch ends the program with one line and exit
/// code 1. TBB throws such ones when it cannot start its threads.
/// \param path The program's own, as main() gets it.
void endUncaughtInOneLine(const char* path);

}  // namespace polemcl::apps
