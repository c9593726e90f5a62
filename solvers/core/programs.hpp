// Programs that weir starts (gnuplot, ffmpeg, itself). Each gets its words as a list by posix_spawn: no shell reads them, so no name of a
// file, title or value in them can be a command.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weir {

struct ProgramStreams {
    std::filesystem::path out{};  // file that takes its standard output; empty: ours
    bool quiet = false;           // its standard error is dropped
};

/// Whether a program of this name stands on the PATH.
bool has_program(const std::string& name);

/// Runs it and waits. Its exit code; 128 + the signal that ended it; 127 where it cannot be started.
int run_program(const std::vector<std::string>& words, const ProgramStreams& streams = {});

/// What it prints; nothing where it fails. Its standard error is dropped.
std::optional<std::string> output_of_program(const std::vector<std::string>& words);

/// A path that no program takes for an option: "./-f.mp4".
std::string file_argument(const std::filesystem::path& path);

}  // namespace weir
