#include "sss/base/error.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(Error, ReadsWhereWhatHint) {
    const Error error(ErrorKind::BadInput, "a.json:14:9", "unknown key \"x\"",
                      "did you mean \"y\"?");
    EXPECT_STREQ(error.what(), "a.json:14:9: unknown key \"x\"; did you mean \"y\"?");
    EXPECT_EQ(error.where(), "a.json:14:9");
    EXPECT_STREQ(Error(ErrorKind::Io, "", "what").what(), "what");
    EXPECT_STREQ(Error(ErrorKind::Io, "where", "what").what(), "where: what");
}

TEST(Error, KindsAreTheDocumentedExitCodes) {
    const auto code = [](ErrorKind kind) { return Error(kind, "", "x").exitCode(); };
    EXPECT_EQ(code(ErrorKind::Internal), 1);
    EXPECT_EQ(code(ErrorKind::Usage), 2);
    EXPECT_EQ(code(ErrorKind::BadInput), 3);
    EXPECT_EQ(code(ErrorKind::Io), 4);
    EXPECT_EQ(code(ErrorKind::Resource), 5);
    EXPECT_EQ(code(ErrorKind::Strict), 6);
}

}  // namespace
}  // namespace sss
