// The executable as a user starts it: arguments, signals, exit code, what it says.
#pragma once
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace weir::test {

inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The rows of a CSV file by the names of its columns, without empty cells.
inline std::vector<std::map<std::string, double>> rows_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line, cell;
    std::vector<std::string> names;
    std::vector<std::map<std::string, double>> rows;
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        if (!names.empty()) rows.emplace_back();
        for (std::size_t i = 0; std::getline(cells, cell, ','); ++i)
            if (rows.empty())
                names.push_back(cell);
            else if (!cell.empty())
                rows.back()[names.at(i)] = std::stod(cell);
    }
    return rows;
}

/// build/<preset>/weir with arguments, its output in a file. Runs until wait() or the destructor, which kills it.
class Process {
public:
    Process(std::vector<std::string> arguments, std::filesystem::path log, rlim_t largest_file = RLIM_INFINITY) : log_(std::move(log)) {
        arguments.insert(arguments.begin(), WEIR_EXECUTABLE);
        std::vector<char*> argv;
        for (auto& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ != 0) return;
        const int file = open(log_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        if (largest_file != RLIM_INFINITY) {
            const rlimit limit{largest_file, largest_file};
            setrlimit(RLIMIT_FSIZE, &limit);
        }
        execv(argv[0], argv.data());
        _exit(127);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (pid_ > 0) kill(pid_, SIGKILL), wait();
    }
    void signal(int number) const { kill(pid_, number); }
    bool running() {
        if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = 0;
        return pid_ > 0;
    }
    /// Its exit code; 128 + the signal that killed it.
    int wait() {
        if (rusage usage{}; pid_ > 0 && wait4(pid_, &status_, 0, &usage) == pid_) most_kilobytes_ = usage.ru_maxrss;
        pid_ = 0;
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    }
    /// Waits until the file exists; throws when the process ends first.
    void wait_for(const std::filesystem::path& file) {
        while (!std::filesystem::exists(file)) {
            if (!running()) throw std::runtime_error("weir ended before it wrote " + file.string() + ":\n" + said());
            usleep(1000);
        }
    }
    /// The most memory that it had at a time, once it was waited for [bytes].
    double most_memory() const { return 1024.0 * static_cast<double>(most_kilobytes_); }
    std::string said() const { return text_of(log_); }

private:
    std::filesystem::path log_;
    pid_t pid_ = -1;
    int status_ = 0;
    long most_kilobytes_ = 0;
};

struct Answer {
    int code;
    std::string text;
};
/// What the executable says to these arguments, waited for.
inline Answer weir_says(std::vector<std::string> arguments) {
    TemporaryFolder folder;
    Process process(std::move(arguments), folder.path() / "log");
    const int code = process.wait();
    return {code, process.said()};
}

/// Every file below `a` but run.json and timings.csv (they hold milliseconds) and checkpoints has a twin below `b` with the same bytes, and
/// none is missing. Returns the first that differs; empty where all agree.
inline std::string first_difference(const std::filesystem::path& a, const std::filesystem::path& b) {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(from)) {
            const auto name = std::filesystem::relative(entry.path(), from);
            if (!entry.is_regular_file() || name == "run.json" || name == "timings.csv" || name.extension() == ".weir" ||
                name.extension() == ".log")
                continue;
            if (!std::filesystem::exists(to / name)) return (to / name).string() + " is missing";
            if (text_of(entry.path()) != text_of(to / name)) return name.string() + " differs";
        }
    return "";
}

}  // namespace weir::test
