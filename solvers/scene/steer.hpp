// Keys that may change during a run: those marked as steerable in the schema. Their values are checked as in a file.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// A change in a scene: changes = [ { time = 1.0, key = "effects.gravity.g", value = [0, 9.81] } ].
struct TimedChange {
    double time = 0;  // [s]
    Override what;
};
std::vector<TimedChange> changes_of(const Table& root);
/// time.end after these changes [s].
double end_after(double end, const std::vector<TimedChange>& changes);

/// The reason why a key of this scene cannot change during its run; empty where it can.
std::string why_not_steerable(const Table& root, const SolverSchema& solver, std::string_view path);
/// The steerable keys of this scene.
std::vector<std::string> steerable_keys(const Table& root, const SolverSchema& solver);
/// The key at a path of this scene ("effects.gravity.g"); nullptr where there is none.
const Key* key_at(const std::vector<Key>& keys, std::string_view path);

/// Sets the key in `root`, or adds a problem. `number`: index of the override, for positions.
void steer(Table& root, int dim, const SolverSchema& solver, const Override& change, int number, std::vector<Problem>& problems);
/// Checks each of the scene's changes in order; problems are reported at the change.
void check_changes(const Table& root, int dim, const std::string& file, const SolverSchema& solver, std::vector<Problem>& problems);

}  // namespace weir::scene
