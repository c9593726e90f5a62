// Numbers of a small run, kept beside what was published from a large one: the tests make the small run again, so that published results
// that are older than the code are found.
#pragma once
#include "core/types.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::validation {

/// By what they are of: "flip at 64: volume.drift".
using Numbers = std::map<std::string, real>;

/// The numbers to nine digits, with the commit, what decides this build's last digits, and the seconds that publishing took.
nlohmann::json pins_json(const Numbers& numbers, double seconds_to_publish);
/// Writes them to pins_file(published, name).
void write_pins(const nlohmann::json& pins, const std::filesystem::path& published, const std::string& name);

/// Where the pins of a case or study lie below the folder that it is published in: pins/<name>.json.
std::filesystem::path pins_file(const std::filesystem::path& published, const std::string& name);

/// Two numbers are the same where they differ by at most 1e-6 of the larger, or are both below 1e-9, which is round-off: a sum in another
/// order changes the last digits of a smooth result, a change of the method changes more.
bool same_number(real a, real b);

/// What has moved since it was published.
struct Comparison {
    std::vector<std::string> moved{};  // "flip at 64: volume.drift moved by 3%: 1.2e-4 published, 1.6e-4 now"
    std::string not_compared{};        // why the numbers were not: another processor, nothing published; empty: they were
    double seconds_to_publish = 0;
};
Comparison compare_numbers(const Numbers& now, const nlohmann::json& pins);

/// What a number is now, beside what it was.
std::string moved_text(const std::string& name, real published, real now);

/// For the terminal: what moved, and the command that publishes anew; empty where everything was compared and nothing moved.
std::string comparison_text(const std::string& name, const std::string& command, const Comparison& comparison);

/// Why numbers of pins made elsewhere cannot be compared here; empty where they can.
std::string rounds_otherwise(const nlohmann::json& pins);

}  // namespace weir::validation
