// Keys that may change while a run goes on: those that the schema marks as steerable. Their values are checked as in a file.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// A change that a scene names: changes = [ { time = 1.0, key = "effects.gravity.g", value = [0, 9.81] } ].
struct TimedChange {
    double time = 0;  // [s]
    Override what;
};
std::vector<TimedChange> changes_of(const Table& root);
/// time.end as these changes leave it [s].
double end_after(double end, const std::vector<TimedChange>& changes);

/// Why a key of this scene cannot change while its run goes on; empty where it can.
std::string why_not_steerable(const Table& root, const SolverSchema& solver, std::string_view path);
/// The keys of this scene that can.
std::vector<std::string> steerable_keys(const Table& root, const SolverSchema& solver);
/// The key at a path of this scene ("effects.gravity.g"); nullptr where there is none.
const Key* key_at(const std::vector<Key>& keys, std::string_view path);

/// Sets the key in `root`, or adds what is wrong with it. `number`: of the override, for its place.
void steer(Table& root, int dim, const SolverSchema& solver, const Override& change, int number, std::vector<Problem>& problems);
/// Each of the scene's changes, one after the other; what is wrong stands at the change.
void check_changes(const Table& root, int dim, const std::string& file, const SolverSchema& solver, std::vector<Problem>& problems);

}  // namespace weir::scene
