// What weir validate, cost and stability take alike: names or --all, a size, folders, threads.
#pragma once
#include "core/parallel.hpp"
#include "validation/harness/case.hpp"

#include <CLI/CLI.hpp>

#include <string>

namespace weir::app {

/// `Options` is the command's own struct, with names, all, list, size, out, publish and quiet.
template <class Options>
struct StudyArguments {
    Options options;
    std::string size = "ci", out, publish_to;
    int threads = 0;
    bool publish = false;

    StudyArguments(std::string out_folder, std::string publish_folder)
        : out(std::move(out_folder)), publish_to(std::move(publish_folder)) {}

    /// `all`, `size_text`, `out_text`: what the command says of --all, --size and --out.
    void add_to(CLI::App& command, const std::string& all, const std::string& size_text, const std::string& out_text) {
        command.add_option("names", options.names, "Cases by name, or their folders");
        command.add_flag("--all", options.all, all);
        command.add_flag("--list", options.list, "List the available cases; run nothing");
        command.add_option("--size", size, size_text)->check(CLI::IsMember({"ci", "full"}));
        command.add_option("--out", out, out_text + " (default: " + out + ")");
        command.add_option("--threads", threads, "Number of threads; results do not depend on it")->check(CLI::Range(1, 1024));
        command.add_flag("--publish", publish, "Also write the page of results");
        command.add_option("--publish-to", publish_to, "Its folder (default: " + publish_to + ")");
        command.add_flag("--quiet", options.quiet, "No progress line");
    }
    /// The command's options, as the user chose.
    const Options& chosen() {
        if (threads > 0) set_threads(threads);
        options.size = size == "full" ? validation::Size::full : validation::Size::ci;
        options.out = out;
        if (publish) options.publish = publish_to;
        return options;
    }
};

}  // namespace weir::app
