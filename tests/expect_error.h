// EXPECT_SVDAG_ERROR(statement, code, part): the statement throws an Error with this exit code
// whose sentence contains `part`.
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
