#pragma once
// Expects a text within another, and shows the whole text when it is not there.

#include <gtest/gtest.h>

#include <string>

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
