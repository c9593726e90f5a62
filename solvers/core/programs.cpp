#include "core/programs.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace weir {

namespace {

/// Redirections of a child's streams, made before it starts.
class Actions {
public:
    Actions() { posix_spawn_file_actions_init(&actions_); }
    ~Actions() { posix_spawn_file_actions_destroy(&actions_); }
    Actions(const Actions&) = delete;
    Actions& operator=(const Actions&) = delete;
    void drop(int stream) { posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_RDWR, 0); }
    void write_to(int stream, const std::filesystem::path& file) {
        posix_spawn_file_actions_addopen(&actions_, stream, file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    }
    void join(int from, int stream) { posix_spawn_file_actions_adddup2(&actions_, from, stream); }
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

/// Returns -1 where it cannot be started.
pid_t start(const std::vector<std::string>& words, const Actions& actions) {
    std::vector<char*> argv;
    for (const auto& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_t child = -1;
    return posix_spawnp(&child, argv[0], actions.get(), nullptr, argv.data(), environ) == 0 ? child : -1;
}

int exit_code_of(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) != child)
        if (errno != EINTR) return 127;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

bool has_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    const std::string list = path ? path : "";
    for (std::size_t from = 0; from <= list.size();) {
        const std::size_t end = std::min(list.find(':', from), list.size());
        if (access((list.substr(from, end - from) + "/" + name).c_str(), X_OK) == 0) return true;
        from = end + 1;
    }
    return false;
}

int run_program(const std::vector<std::string>& words, const ProgramStreams& streams) {
    Actions actions;
    actions.drop(STDIN_FILENO);
    if (!streams.out.empty()) actions.write_to(STDOUT_FILENO, streams.out);
    if (streams.quiet) actions.drop(STDERR_FILENO);
    const pid_t child = start(words, actions);
    return child < 0 ? 127 : exit_code_of(child);
}

std::optional<std::string> output_of_program(const std::vector<std::string>& words) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
    Actions actions;
    actions.drop(STDIN_FILENO);
    actions.join(ends[1], STDOUT_FILENO);
    actions.drop(STDERR_FILENO);
    const pid_t child = start(words, actions);
    close(ends[1]);
    std::string text;
    char piece[4096];
    for (ssize_t got = 0; child >= 0 && ((got = read(ends[0], piece, sizeof piece)) > 0 || (got < 0 && errno == EINTR));)
        if (got > 0) text.append(piece, static_cast<std::size_t>(got));
    close(ends[0]);
    if (child < 0 || exit_code_of(child) != 0) return std::nullopt;
    return text;
}

std::string file_argument(const std::filesystem::path& path) {
    const std::string text = path.string();
    return text.starts_with('-') ? "./" + text : text;
}

}  // namespace weir
