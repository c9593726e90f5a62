// The first line of a test that every backend shares: where this machine cannot run the backend, the test is skipped and says why.
#pragma once
#include "core/error.hpp"

#include "support/test.hpp"

#define NEEDS_BACKEND \
    if (const std::string why = weir::test::missing(); !why.empty()) GTEST_SKIP() << why
