#include "sss/cloud/cache_file.h"

#include "sss/base/error.h"
#include "sss/base/vec.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <functional>
#include <numeric>

namespace sss {
namespace {

using testing::readFile;
using testing::TemporaryFolder;
using testing::writeFile;

constexpr Fingerprint kPointsPrint{0x1122334455667788, 0x99aabbccddeeff00};
constexpr Fingerprint kTreePrint{1, 2};

struct Node {
    float flux[3];
    std::uint32_t firstChild;
};

std::vector<Vec3> somePoints() { return {{1, 2, 3}, {-4, 5.5f, 6}, {7, 8, -9e30f}}; }

void writeSample(const std::filesystem::path& path) {
    CacheWriter writer(path);
    const std::vector<Vec3> points = somePoints();
    const std::vector<Node> nodes{{{1, 2, 3}, 0}, {{4, 5, 6}, 7}};
    writer.addText("meta", 0, {}, R"({"spacingMm": 0.25})");
    writer.add("points", 0, kPointsPrint, std::span(points));
    writer.add("points", 1, kTreePrint, std::span(points).first(1));
    writer.add("nodes", 1, kTreePrint, std::span(nodes));
    writer.add("empty", 0, {}, std::span<const double>());
    writer.commit();
}

std::string messageOf(const std::function<void()>& action, ErrorKind kind = ErrorKind::BadInput) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error was thrown";
    return {};
}

std::string refusal(const std::filesystem::path& path, const std::string& bytes,
                    ErrorKind kind = ErrorKind::BadInput) {
    writeFile(path, bytes);
    return messageOf([&] { CacheFile::open(path).checkAll(); }, kind);
}

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

/// Bytes of the sample with its header and table changed and all checksums of those made right.
std::string forged(const std::string& whole,
                   const std::function<void(CacheHeader&, std::vector<CacheEntry>&)>& change) {
    CacheHeader header;
    std::memcpy(&header, whole.data(), sizeof header);
    std::vector<CacheEntry> table(header.sectionCount);
    const std::size_t tableOffset = header.tableOffset;
    std::memcpy(table.data(), whole.data() + tableOffset, table.size() * sizeof table[0]);
    change(header, table);
    std::string bytes = whole;
    std::memcpy(bytes.data() + tableOffset, table.data(), table.size() * sizeof table[0]);
    header.checksum =
        cacheHeaderChecksum(header, std::as_bytes(std::span(bytes).subspan(tableOffset)));
    std::memcpy(bytes.data(), &header, sizeof header);
    return bytes;
}

class CacheFileTest : public ::testing::Test {
protected:
    CacheFileTest() {
        writeSample(path);
        whole = readFile(path);
    }
    TemporaryFolder folder;
    std::filesystem::path path = folder / "sample.ssc";
    std::filesystem::path damaged = folder / "damaged.ssc";
    std::string whole;
};

TEST_F(CacheFileTest, RoundTrip) {
    const CacheFile cache = CacheFile::open(path);
    EXPECT_EQ(cache.fileBytes(), whole.size());
    ASSERT_EQ(cache.sections().size(), 5u);
    EXPECT_EQ(cache.text("meta", 0), R"({"spacingMm": 0.25})");
    const auto points = cache.section<Vec3>("points", 0);
    ASSERT_EQ(points.size(), 3u);
    EXPECT_EQ(std::memcmp(points.data(), somePoints().data(), points.size_bytes()), 0);
    EXPECT_EQ(cache.section<Vec3>("points", 1).size(), 1u);
    EXPECT_EQ(cache.section<Node>("nodes", 1)[1].firstChild, 7u);
    EXPECT_TRUE(cache.section<double>("empty", 0).empty());
    const SectionInfo* info = cache.find("points", 0);
    ASSERT_NE(info, nullptr);
    EXPECT_EQ(info->fingerprint, kPointsPrint);
    EXPECT_EQ(info->count, 3u);
    EXPECT_EQ(info->elementBytes, sizeof(Vec3));
    EXPECT_EQ(cache.find("points", 2), nullptr);
    EXPECT_EQ(cache.find("exitance", 0), nullptr);
}

TEST_F(CacheFileTest, SectionsAreAlignedForAnyVectorType) {
    const CacheFile cache = CacheFile::open(path);
    for (const SectionInfo& section : cache.sections()) EXPECT_EQ(section.offset % 64, 0u);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(cache.section<Node>("nodes", 1).data()) % 64, 0u);
}

TEST_F(CacheFileTest, SameInputSameBytes) {
    writeSample(folder / "again.ssc");
    EXPECT_EQ(readFile(folder / "again.ssc"), whole);
}

TEST_F(CacheFileTest, StaysReadableAfterItIsReplaced) {
    const CacheFile cache = CacheFile::open(path);
    CacheWriter(path).commit();
    EXPECT_TRUE(CacheFile::open(path).sections().empty());
    EXPECT_EQ(cache.section<Vec3>("points", 0)[1].y, 5.5f);
}

TEST_F(CacheFileTest, MissingSectionAndWrongElementSizeAreNamed) {
    const CacheFile cache = CacheFile::open(path);
    EXPECT_TRUE(contains(messageOf([&] { cache.section<Vec3>("points", 9); }),
                         "no section 'points' of body 9"));
    EXPECT_TRUE(contains(messageOf([&] { cache.section<double>("points", 0); }),
                         "elements of 12 bytes, not 8"));
}

TEST_F(CacheFileTest, WriterRefusesBadNames) {
    CacheWriter writer(damaged);
    for (const char* kind : {"", "ninechars", "a b", "\xc3\xa4"})
        messageOf([&] { writer.addText(kind, 0, {}, "x"); }, ErrorKind::Internal);
    writer.addText("a", 0, {}, "x");
    messageOf([&] { writer.addText("a", 0, {}, "x"); }, ErrorKind::Internal);
}

TEST_F(CacheFileTest, EveryTruncationIsANamedError) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string message = refusal(damaged, whole.substr(0, length));
        EXPECT_TRUE(contains(message, length == 0  ? "empty"
                                      : length < 8 ? "truncated: a header takes"
                                                   : "truncated"))
            << length << ": " << message;
        EXPECT_TRUE(contains(message, "damaged.ssc")) << message;
    }
}

TEST_F(CacheFileTest, EveryFlippedByteIsANamedError) {
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const int mask : {0x01, 0x80, 0xff}) {
            std::string bytes = whole;
            bytes[i] = static_cast<char>(bytes[i] ^ mask);
            EXPECT_FALSE(refusal(damaged, bytes).empty()) << "byte " << i;
        }
}

TEST_F(CacheFileTest, DamagedDataNamesItsSection) {
    const SectionInfo info = *CacheFile::open(path).find("points", 1);
    std::string bytes = whole;
    bytes[info.offset + 5] ^= 0x10;
    const std::string message = refusal(damaged, bytes);
    EXPECT_TRUE(contains(message, "section 'points' of body 1 is damaged (checksum)")) << message;
    EXPECT_TRUE(contains(message, "run sss-preprocess again")) << message;
    bytes = whole;
    bytes[info.offset + info.bytes] = 1;  // the gap behind it
    EXPECT_TRUE(contains(refusal(damaged, bytes), "damaged between sections"));
}

TEST_F(CacheFileTest, GrownFileIsRefused) {
    EXPECT_TRUE(contains(refusal(damaged, whole + std::string(64, '\0')), "too long"));
}

TEST_F(CacheFileTest, OtherFilesAreNotCaches) {
    EXPECT_TRUE(contains(refusal(damaged, "ply\nformat ascii 1.0\n"), "not a cache file"));
    EXPECT_TRUE(contains(messageOf([&] { CacheFile::open(folder / "none"); }, ErrorKind::Io),
                         "No such file"));
    EXPECT_TRUE(contains(messageOf([&] { CacheFile::open(folder.path()); }, ErrorKind::Io),
                         "Is a directory"));
    EXPECT_TRUE(contains(messageOf([&] { CacheFile::open("/dev/zero"); }, ErrorKind::Io),
                         "not a regular file"));
}

TEST_F(CacheFileTest, OtherVersionsAndByteOrders) {
    const auto message = [&](auto change) { return refusal(damaged, forged(whole, change)); };
    EXPECT_TRUE(contains(message([](CacheHeader& h, auto&) { h.version = 6; }),
                         "format 6 is newer than this program's 5"));
    EXPECT_TRUE(contains(message([](CacheHeader& h, auto&) { h.version = 4; }),
                         "format 4 is older than this program's 5"));
    EXPECT_TRUE(
        contains(message([](CacheHeader& h, auto&) { h.endianMark = 0x04030201; }), "byte order"));
}

TEST_F(CacheFileTest, AbsurdNumbersAreRefusedWithoutAllocation) {
    constexpr std::uint64_t kHuge = std::uint64_t{1} << 63;
    using Table = std::vector<CacheEntry>;
    const auto message = [&](auto change) { return refusal(damaged, forged(whole, change)); };
    for (const std::uint64_t n : {kHuge, kHuge + 5, ~std::uint64_t{0}, std::uint64_t{1} << 58}) {
        EXPECT_TRUE(contains(message([&](CacheHeader& h, Table&) { h.sectionCount = n; }),
                             "sections do not fit"));
        EXPECT_TRUE(
            contains(message([&](CacheHeader& h, Table&) { h.fileBytes = n; }), "truncated"));
        EXPECT_TRUE(contains(message([&](CacheHeader& h, Table&) { h.tableOffset = n; }),
                             "place of the table"));
        EXPECT_TRUE(contains(message([&](auto&, Table& t) { t[1].count = n; }), "elements of 12"));
        EXPECT_TRUE(
            contains(message([&](auto&, Table& t) { t[1].bytes = n; }), "outside the file"));
        EXPECT_TRUE(
            contains(message([&](auto&, Table& t) { t[1].offset = n; }), "outside the file"));
    }
    // A product that wraps to the right number of bytes.
    EXPECT_TRUE(contains(message([&](auto&, Table& t) {
                             t[1].elementBytes = 4;
                             t[1].count = (std::uint64_t{1} << 62) + t[1].bytes / 4;
                         }),
                         "elements of 4 bytes"));
    EXPECT_TRUE(
        contains(message([](auto&, Table& t) { t[1].elementBytes = 0; }), "elements of 0 bytes"));
}

TEST_F(CacheFileTest, HostileTablesAreRefused) {
    using Table = std::vector<CacheEntry>;
    const auto message = [&](auto change) { return refusal(damaged, forged(whole, change)); };
    EXPECT_TRUE(contains(message([](auto&, Table& t) { t[2].offset = t[1].offset; }),
                         "over another section"));
    EXPECT_TRUE(contains(message([](auto&, Table& t) { t[2].offset += 4; }), "outside the file"));
    EXPECT_TRUE(contains(message([](auto&, Table& t) { t[2].body = 0; }), "twice"));
    EXPECT_TRUE(contains(message([](auto&, Table& t) { t[1].kind = {}; }), "no valid name"));
    EXPECT_TRUE(contains(message([](auto&, Table& t) { t[1].kind[7] = 'x'; }), "no valid name"));
    EXPECT_TRUE(contains(message([](CacheHeader& h, auto&) { h.entryBytes = 32; }), "sizes"));
    EXPECT_TRUE(contains(message([](CacheHeader& h, auto&) { h.reserved = 1; }), "sizes"));
    // A section taken out of the table leaves bytes that nothing accounts for.
    EXPECT_TRUE(contains(message([](auto&, Table& t) {
                             t[1].offset = t[2].offset;
                             t[1].bytes = t[2].bytes;
                             t[1].count = t[2].count;
                             t[2].offset = t[3].offset;
                             t[2].bytes = t[2].count = 0;
                         }),
                         "damaged between sections"));
}

TEST_F(CacheFileTest, ChecksumsForOtherPartsAreRefused) {
    using Table = std::vector<CacheEntry>;
    const auto message = [&](auto change) { return refusal(damaged, forged(whole, change)); };
    for (const std::uint64_t n : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}})
        EXPECT_TRUE(contains(message([&](auto&, Table& t) { t[2].firstPart = n; }),
                             "has its checksums elsewhere"));
    EXPECT_TRUE(contains(message([](auto&, Table& t) {
                             t[3].count = t[3].bytes = 0;
                             t[4].firstPart -= 1;
                             t[4].offset = t[3].offset;
                         }),
                         "damaged between sections"));
    // As many sections, one checksum more.
    std::string longer = whole + std::string(8, '\0');
    longer = forged(longer, [&](CacheHeader& h, Table&) { h.fileBytes = longer.size(); });
    EXPECT_TRUE(contains(refusal(damaged, longer), "5 checksums for 4 parts"));
}

TEST_F(CacheFileTest, PartsAreCheckedWhenAskedFor) {
    std::vector<std::uint64_t> numbers(100'000);
    std::iota(numbers.begin(), numbers.end(), 0);
    {
        CacheWriter writer(path);
        writer.add("numbers", 0, {}, std::span(std::as_const(numbers)));
        writer.addText("meta", 0, {}, "{}");
        writer.commit();
    }
    std::string bytes = readFile(path);
    const SectionInfo info = *CacheFile::open(path).find("numbers", 0);
    const std::size_t place = 20'000;
    bytes[info.offset + place * sizeof numbers[0]] ^= 1;
    writeFile(path, bytes);
    const CacheFile cache = CacheFile::open(path);
    EXPECT_EQ(cache.text("meta", 0), "{}");
    const auto unchecked = cache.unchecked<std::uint64_t>("numbers", 0);
    const std::size_t bad = place >> unchecked.parts.shift();
    std::size_t elements = 0;
    for (std::size_t part = 0; part < unchecked.parts.count(); ++part) {
        EXPECT_EQ(unchecked.part(part)[0], elements + (elements == place ? 1 : 0));
        elements += unchecked.part(part).size();
        if (part != bad)
            unchecked.parts.check(part);
        else
            EXPECT_TRUE(contains(messageOf([&] { unchecked.parts.check(part); }),
                                 "section 'numbers' of body 0 is damaged (checksum)"));
    }
    EXPECT_EQ(elements, numbers.size());
    EXPECT_GT(bad, 0u);
    messageOf([&] { cache.section<std::uint64_t>("numbers", 0); });
}

TEST_F(CacheFileTest, UnknownKindsAreNoError) {
    CacheWriter writer(path);
    writer.addText("future", 3, {}, "whatever");
    writer.addText("meta", 0, {}, "{}");
    writer.commit();
    EXPECT_EQ(CacheFile::open(path).text("meta", 0), "{}");
}

TEST_F(CacheFileTest, TwoWritersAtOnceLeaveOneWholeFile) {
    CacheWriter first(path), second(path);
    first.addText("who", 0, {}, "first");
    second.addText("who", 0, {}, "second");
    second.commit();
    EXPECT_EQ(CacheFile::open(path).text("who", 0), "second");
    first.commit();
    EXPECT_EQ(CacheFile::open(path).text("who", 0), "first");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST_F(CacheFileTest, UncommittedWriterLeavesTheOldFile) {
    {
        CacheWriter writer(path);
        writer.addText("who", 0, {}, "never");
    }
    EXPECT_EQ(readFile(path), whole);
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST_F(CacheFileTest, FullDiskLeavesTheOldFile) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit tiny = before;
    tiny.rlim_cur = 4096;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tiny), 0);
    const std::vector<double> much(100'000, 1.0);
    const std::string message = messageOf(
        [&] {
            CacheWriter writer(path);
            writer.add("much", 0, {}, std::span(much));
            writer.commit();
        },
        ErrorKind::Io);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, oldHandler);
    EXPECT_TRUE(contains(message, "cannot write")) << message;
    EXPECT_EQ(readFile(path), whole);
    EXPECT_EQ(folder.fileCount(), 1u);
}

}  // namespace
}  // namespace sss
