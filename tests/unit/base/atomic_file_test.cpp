#include "sss/base/atomic_file.h"

#include "sss/base/abandoned_files.h"
#include "sss/base/error.h"
#include "support/full_disk.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace sss {
namespace {

using testing::readFile;
using testing::TemporaryFolder;
using testing::writeFile;

std::string ioMessage(const std::filesystem::path& target) {
    try {
        AtomicFile(target).commit();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        return error.what();
    }
    ADD_FAILURE() << target << " was written";
    return {};
}

TEST(AtomicFile, AppearsOnlyOnCommit) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "out");
    file.append("hello ");
    file.append("world");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    EXPECT_TRUE(std::filesystem::exists(file.temporaryPath()));
    file.commit();
    EXPECT_EQ(readFile(folder / "out"), "hello world");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, DroppedLeavesTheOldFile) {
    const TemporaryFolder folder;
    writeFile(folder / "out", "old");
    { AtomicFile(folder / "out").append("new"); }
    EXPECT_EQ(readFile(folder / "out"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, OverwriteReplacesBytesInPlace) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "out");
    file.append("____world");
    file.overwrite(1, std::as_bytes(std::span("abc", 3)));
    file.append("!");
    file.commit();
    EXPECT_EQ(readFile(folder / "out"), "_abcworld!");
}

TEST(AtomicFile, ASymbolicLinkKeepsPointing) {
    const TemporaryFolder folder;
    writeFile(folder / "real", "old");
    std::filesystem::create_symlink(folder / "real", folder / "link");
    AtomicFile file(folder / "link");
    file.append("new");
    file.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(readFile(folder / "real"), "new");
}

TEST(AtomicFile, RefusalsNameThePathAndTheReason) {
    const TemporaryFolder folder;
    EXPECT_NE(ioMessage(folder.path()).find("Is a directory"), std::string::npos);
    EXPECT_NE(ioMessage("/dev/null").find("not a regular file"), std::string::npos);
    const std::string missing = ioMessage(folder / "none/out");
    EXPECT_NE(missing.find("No such file"), std::string::npos);
    EXPECT_NE(missing.find("none/out"), std::string::npos);
    writeFile(folder / "file", "");
    EXPECT_NE(ioMessage(folder / "file/out").find("Not a directory"), std::string::npos);
    EXPECT_THROW(requireWritable(folder / "none/out"), Error);
}

TEST(AtomicFile, RequireWritableTouchesNothing) {
    const TemporaryFolder folder;
    writeFile(folder / "out", "old");
    requireWritable(folder / "out");
    requireWritable(folder / "new");
    EXPECT_EQ(readFile(folder / "out"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, ALeftoverTemporaryOfADeadProcessIsInNobodysWay) {
    const TemporaryFolder folder;
    std::string next;
    {
        const AtomicFile probe(folder / "out");
        const std::string used = probe.temporaryPath().string();
        const std::size_t dash = used.rfind('-');
        next = used.substr(0, dash + 1) + std::to_string(std::stoul(used.substr(dash + 1)) + 1);
    }
    writeFile(next, "leftover");
    AtomicFile file(folder / "out");
    file.append("new");
    file.commit();
    EXPECT_EQ(readFile(folder / "out"), "new");
    EXPECT_EQ(readFile(next), "leftover");
}

TEST(AtomicFile, WhatAKilledWriterLeftIsRemovedAndNothingElse) {
    using namespace std::chrono_literals;
    const TemporaryFolder folder;
    AtomicFile alive(folder / "out");
    alive.append("half");
    for (const char* name : {"out.tmp-1-2", "out", "out.tmp-1-", "out.tmp-x-2", "out.tmp-1-2.png"})
        writeFile(folder / name, "x");
    std::filesystem::create_directory(folder / "a.tmp-1-1");
    removeAbandonedFiles(folder.path());
    EXPECT_TRUE(std::filesystem::exists(folder / "out.tmp-1-2"));  // it may be from elsewhere
    std::filesystem::last_write_time(folder / "out.tmp-1-2",
                                     std::filesystem::file_time_type::clock::now() - 2h);
    removeAbandonedFiles(folder.path());
    EXPECT_FALSE(std::filesystem::exists(folder / "out.tmp-1-2"));
    removeAbandonedFiles(folder.path(), 0s);
    EXPECT_TRUE(std::filesystem::exists(alive.temporaryPath()));
    EXPECT_EQ(folder.fileCount(), 6u);
    alive.commit();
    EXPECT_EQ(readFile(folder / "out"), "half");
    removeAbandonedFiles(folder / "none");
}

TEST(AtomicFile, IsNotTornFromItsWriterAtItsBirth) {
    using namespace std::chrono_literals;
    const TemporaryFolder folder;
    std::atomic<bool> isDone{false};
    std::thread cleaner([&] {
        while (!isDone) removeAbandonedFiles(folder.path(), 0s);
    });
    for (int i = 0; i < 500; ++i) {
        AtomicFile file(folder / "out");
        EXPECT_TRUE(std::filesystem::exists(file.temporaryPath()));
        if (i % 20 != 0) continue;  // the disk takes its time
        file.append("whole");
        EXPECT_NO_THROW(file.commit());
    }
    isDone = true;
    cleaner.join();
    EXPECT_EQ(readFile(folder / "out"), "whole");
}

TEST(AtomicFile, AFullDiskLeavesTheOldFile) {
    const TemporaryFolder folder;
    writeFile(folder / "out", "old");
    const std::string much(1000, 'x');
    for (const bool inPlace : {false, true}) {
        std::string message;
        try {
            const testing::FullDisk disk(100);
            AtomicFile file(folder / "out");
            if (inPlace)
                file.overwrite(0, std::as_bytes(std::span(much)));
            else
                file.append(much);
            file.commit();
        } catch (const Error& error) {
            message = error.what();
        }
        EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    }
    EXPECT_EQ(readFile(folder / "out"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

// A disk that fails says so when it is flushed; a pipe, put in the descriptor's place, cannot be.
TEST(AtomicFile, WhatCannotBeFlushedLeavesTheOldFile) {
    const TemporaryFolder folder;
    writeFile(folder / "out", "old");
    int pipe[2];
    ASSERT_EQ(::pipe(pipe), 0);
    std::string message;
    try {
        AtomicFile file(folder / "out");
        file.append("new");
        for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
            std::error_code ignored;
            if (std::filesystem::read_symlink(entry.path(), ignored) == file.temporaryPath())
                dup2(pipe[1], std::stoi(entry.path().filename().string()));
        }
        file.commit();
    } catch (const Error& error) {
        message = error.what();
    }
    for (const int end : pipe) close(end);
    EXPECT_NE(message.find("out: cannot flush: Invalid argument"), std::string::npos) << message;
    EXPECT_EQ(readFile(folder / "out"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

// Somebody makes a folder of that name while the file is being written.
TEST(AtomicFile, AFolderThatCameMeanwhileIsAnErrorAndStays) {
    const TemporaryFolder folder;
    std::string message;
    try {
        AtomicFile file(folder / "out");
        file.append("new");
        std::filesystem::create_directory(folder / "out");
        file.commit();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        message = error.what();
    }
    EXPECT_NE(message.find("cannot rename into place: Is a directory"), std::string::npos)
        << message;
    EXPECT_TRUE(std::filesystem::is_directory(folder / "out"));
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, ManyWritersOfOneNameLeaveOneOfThem) {
    const TemporaryFolder folder;
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&folder, i] {
            for (int k = 0; k < 20; ++k) {
                AtomicFile file(folder / "out");
                file.append(std::string(10'000, static_cast<char>('a' + i)));
                file.commit();
            }
        });
    for (std::thread& thread : threads) thread.join();
    const std::string text = readFile(folder / "out");
    EXPECT_EQ(text.size(), 10'000u);
    EXPECT_TRUE(std::all_of(text.begin(), text.end(), [&](char c) { return c == text[0]; }));
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, RemoveTemporaryFilesFindsAllThatAreAlive) {
    const TemporaryFolder folder;
    writeFile(folder / "committed", "old");
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (int i = 0; i < 20; ++i)
        files.push_back(std::make_unique<AtomicFile>(folder / std::to_string(i).c_str()));
    files[3]->commit();
    files[4].reset();
    EXPECT_EQ(folder.fileCount(), 20u);
    removeTemporaryFiles();
    EXPECT_EQ(folder.fileCount(), 2u);
    EXPECT_TRUE(std::filesystem::exists(folder / "3"));
}

}  // namespace
}  // namespace sss
