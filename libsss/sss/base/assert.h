#pragma once
#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>

/// Preconditions of kernels: on in every build but Release; prints both operands.
#ifdef SSS_ASSERTIONS
#define SSS_ASSERT_OP(a, op, b)                                                               \
    do {                                                                                      \
        const auto sssA = (a);                                                                \
        const auto sssB = (b);                                                                \
        if (!(sssA op sssB)) {                                                                \
            fmt::print(stderr, "{}:{}: assertion {} {} {} failed: {} against {}\n", __FILE__, \
                       __LINE__, #a, #op, #b, sssA, sssB);                                    \
            std::abort();                                                                     \
        }                                                                                     \
    } while (false)
#else
#define SSS_ASSERT_OP(a, op, b) static_cast<void>(0)
#endif

#define SSS_ASSERT_LT(a, b) SSS_ASSERT_OP(a, <, b)
#define SSS_ASSERT_LE(a, b) SSS_ASSERT_OP(a, <=, b)
#define SSS_ASSERT_GE(a, b) SSS_ASSERT_OP(a, >=, b)
#define SSS_ASSERT_EQ(a, b) SSS_ASSERT_OP(a, ==, b)
