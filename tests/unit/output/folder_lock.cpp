#include "output/folder_lock.hpp"

#include "core/error.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace folder_lock_tests {

namespace {

using weir::output::FolderLock;

TEST("a folder has one lock at a time; who waits is told the process; afterwards nothing is left of it") {
    weir::test::TemporaryFolder folder;
    const auto file = folder.path() / FolderLock::file_name;
    for (int i = 0; i < 2; ++i) {
        const FolderLock lock(folder.path());
        ASSERT_EQ(lock.unlocked(), "");
        try {
            const FolderLock second(folder.path());
            ADD_FAILURE() << "two locks";
        } catch (const weir::BadInput& refusal) {
            EXPECT_NE(std::string(refusal.what()).find("process " + std::to_string(getpid())), std::string::npos) << refusal.what();
            EXPECT_NE(std::string(refusal.what()).find(folder.path().string()), std::string::npos) << refusal.what();
        }
        EXPECT_TRUE(std::filesystem::exists(file));
    }
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST("a lock ends with its process, whose file is no obstacle") {
    weir::test::TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) {
        const FolderLock lock(folder.path());
        _exit(0);  // as a killed process: nothing is cleaned up
    }
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / FolderLock::file_name));
    EXPECT_EQ(FolderLock(folder.path()).unlocked(), "");
}

TEST("a lock that may wait is taken when the other one is released") {
    weir::test::TemporaryFolder folder;
    auto first = std::make_unique<FolderLock>(folder.path());
    std::atomic<bool> released = false;
    std::thread other([&] {
        const FolderLock second(folder.path(), FolderLock::IfTaken::wait);
        EXPECT_TRUE(released);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    released = true;
    first.reset();
    other.join();
    EXPECT_FALSE(std::filesystem::exists(folder.path() / FolderLock::file_name));
}

TEST("no link leads the lock to another file") {
    weir::test::TemporaryFolder folder;
    std::ofstream(folder.path() / "mine") << "mine";
    std::filesystem::create_symlink(folder.path() / "mine", folder.path() / FolderLock::file_name);
    EXPECT_THROW(FolderLock(folder.path()), weir::OutputError);
    EXPECT_EQ(std::filesystem::file_size(folder.path() / "mine"), 4u);
}

}  // namespace

}  // namespace folder_lock_tests
