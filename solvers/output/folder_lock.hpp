// One run at a time per folder: a lock on a file in it, which the kernel releases when the process ends in any way.
#pragma once
#include <filesystem>
#include <string>

namespace weir::output {

class FolderLock {
public:
    static constexpr const char* file_name = ".weir_lock";

    enum class IfTaken { refuse, wait };

    /// Takes the lock, or waits until another process releases it. Throws BadInput, naming the owner, where waiting is not allowed. On file
    /// systems without locks the folder is used without one, and unlocked() gives the reason.
    explicit FolderLock(const std::filesystem::path& folder, IfTaken if_taken = IfTaken::refuse);
    /// Removes the file and releases the lock.
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// The reason why there is no lock; empty where there is one.
    const std::string& unlocked() const { return unlocked_; }

private:
    bool try_once();
    [[noreturn]] void refuse() const;

    std::filesystem::path folder_, path_;
    IfTaken if_taken_;
    int descriptor_ = -1;
    std::string unlocked_;
};

}  // namespace weir::output
