#pragma once
/// \file Failure.h
/// \brief How a program that failed says why: in one line, also when a library ends it.

#include <exception>
#include <string>

namespace polemcl::apps {

/// \brief What an exception says, in words for people where memory or threads are missing.
std::string reasonOf(const std::exception& error);

/// \brief Writes "PROGRAM: TEXT" to standard error.
void sayFailure(const std::string& program, const std::string& text);

/// \brief From now on, an exception that nobody can catch ends the program with one line and exit
/// code 1. TBB throws such ones when it cannot start its threads.
/// \param path The program's own, as main() gets it.
void endUncaughtInOneLine(const char* path);

}  // namespace polemcl::apps
