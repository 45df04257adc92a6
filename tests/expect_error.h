// EXPECT_SVDAG_ERROR(statement, code, part): a test expectation that `statement` throws an Error
// with exit code `code` and a what() that contains `part`.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "streaming/error.h"

#define EXPECT_SVDAG_ERROR(statement, expected_code, part)                                \
  do {                                                                                    \
    try {                                                                                 \
      statement;                                                                          \
      ADD_FAILURE() << #statement " did not throw";                                       \
    } catch (const ::svdag::Error& error) {                                               \
      EXPECT_EQ(error.code(), expected_code) << error.what();                             \
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what(); \
    }                                                                                     \
  } while (false)
