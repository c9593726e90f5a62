#include "output/folder_lock.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weir::output {

namespace {

/// The name of this process in error messages.
std::string this_process() {
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    return "process " + std::to_string(getpid()) + " on " + host + '\n';
}

/// The last owner of a lock removes the file while holding the lock: a lock on a removed file has no effect.
bool is_still_there(int descriptor, const std::filesystem::path& path) {
    struct stat open_file {
    }, named{};
    return fstat(descriptor, &open_file) == 0 && stat(path.c_str(), &named) == 0 && open_file.st_ino == named.st_ino &&
           open_file.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, IfTaken if_taken)
    : folder_(folder), path_(folder / file_name), if_taken_(if_taken) {
    while (!try_once()) {
    }
}

/// Returns whether the lock was taken or cannot be.
bool FolderLock::try_once() {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (descriptor_ < 0) throw OutputError("cannot write " + path_.string() + ": " + std::strerror(errno));
    if (flock(descriptor_, if_taken_ == IfTaken::wait ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) return close(descriptor_), false;
        if (errno == EWOULDBLOCK) refuse();
        unlocked_ = std::strerror(errno);
        return true;
    }
    if (!is_still_there(descriptor_, path_)) return close(descriptor_), false;
    const std::string owner = this_process();
    if (ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, owner.data(), owner.size(), 0) < 0) return true;  // full disk: no name
    return true;
}

void FolderLock::refuse() const {
    char text[320] = {};
    const ssize_t count = pread(descriptor_, text, sizeof text - 1, 0);
    close(descriptor_);
    const std::string owner(text, count > 0 ? static_cast<std::size_t>(count) : 0);
    const std::string name = owner.starts_with("process ") ? owner.substr(0, owner.find('\n')) : "another process";
    throw BadInput(folder_.string() + ": another run writes into this folder (" + name +
                   "): wait for its end, or name another folder with --out");
}

FolderLock::~FolderLock() {
    if (descriptor_ < 0) return;
    if (unlocked_.empty()) unlink(path_.c_str());
    close(descriptor_);
}

}  // namespace weir::output
