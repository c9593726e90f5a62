// Programs that weir starts (gnuplot, ffmpeg, itself). Arguments are passed as a list by posix_spawn. No shell reads them, so no file name,
// title or value can act as a command.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weir {

struct ProgramStreams {
    std::filesystem::path out{};  // file that receives its standard output; empty: inherited
    bool quiet = false;           // its standard error is dropped
};

/// Returns whether a program of this name is on the PATH.
bool has_program(const std::string& name);

/// Runs the program and waits. Returns its exit code; 128 + the signal that ended it; 127 where it cannot be started.
int run_program(const std::vector<std::string>& words, const ProgramStreams& streams = {});

/// Returns its standard output; nothing where it fails. Its standard error is dropped.
std::optional<std::string> output_of_program(const std::vector<std::string>& words);

/// Returns a path that no program reads as an option: "./-f.mp4".
std::string file_argument(const std::filesystem::path& path);

}  // namespace weir
